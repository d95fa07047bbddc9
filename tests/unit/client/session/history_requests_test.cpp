#include "client/session/history_requests.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

ViewState state(std::uint32_t request, ViewPhase phase, bool past, std::string text = "") {
  return {request, 1, phase, past, past ? Sequence{5} : 0, 0, std::move(text)};
}

}  // namespace

TEST_CASE("a request for the past loads until it is complete", "[session]") {
  HistoryRequests requests;
  CHECK_FALSE(requests.is_loading());
  CHECK(requests.next({.to = HistoryTarget::sequence, .seq = 5}).request == 1);
  CHECK(requests.is_loading());
  requests.receive(state(1, ViewPhase::begins, true));
  CHECK(requests.is_loading());
  requests.receive(state(1, ViewPhase::complete, true));
  CHECK_FALSE(requests.is_loading());
}

TEST_CASE("a request for the live world loads until it is complete", "[session]") {
  HistoryRequests requests;
  requests.next({});
  requests.receive(state(0, ViewPhase::complete, false));  // of the view before the request
  requests.receive(state(1, ViewPhase::begins, false));
  CHECK(requests.is_loading());
  requests.receive(state(1, ViewPhase::complete, false));
  CHECK_FALSE(requests.is_loading());
}

TEST_CASE("answers to older requests change nothing, and a refusal is kept until the next request",
          "[session]") {
  HistoryRequests requests;
  requests.next({});
  CHECK(requests.next({}).request == 2);
  requests.receive(state(1, ViewPhase::refused, false, "too old"));
  CHECK(requests.is_loading());
  CHECK(requests.refusal().empty());
  requests.receive(state(2, ViewPhase::refused, false, "no such edit"));
  CHECK_FALSE(requests.is_loading());
  CHECK(requests.refusal() == "no such edit");
  requests.next({});
  CHECK(requests.refusal().empty());
  requests.clear();
  CHECK_FALSE(requests.is_loading());
  CHECK(requests.next({}).request == 1);
}
