// HistoryRequests: the requests of one connection to see its view at a moment of the past, or live
// again, and their answers. The newest request replaces those before it. One thread.
#pragma once
#include <cstdint>
#include <string>

#include "protocol/codec/messages.hpp"

namespace runstone {

class HistoryRequests {
 public:
  /// Returns the request with its number, to be sent. It is the newest one from now on.
  HistoryRequest next(HistoryRequest request) {
    request.request = newest_.request + 1;
    newest_ = request;
    refusal_.clear();
    return request;
  }
  /// Takes an answer of the server. Answers to older requests change nothing.
  void receive(const ViewState& state) {
    if (state.request != newest_.request || state.phase == ViewPhase::begins) return;
    answered_ = newest_.request;
    if (state.phase == ViewPhase::refused) refusal_ = state.text;
  }
  void clear() { *this = {}; }

  /// Returns true if the newest request was sent, and not everything that it asked for has arrived.
  bool is_loading() const { return answered_ != newest_.request; }
  /// Returns the newest request; its number is 0 if there was none.
  const HistoryRequest& newest() const { return newest_; }
  /// Returns why the newest request was refused, or an empty string.
  const std::string& refusal() const { return refusal_; }

 private:
  HistoryRequest newest_{.request = 0};
  std::uint32_t answered_ = 0;  // number of the newest one that was fulfilled or refused
  std::string refusal_;
};

}  // namespace runstone
