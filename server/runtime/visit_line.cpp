#include "server/runtime/visit_line.hpp"

#include <utility>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/runtime/log_payload.hpp"

namespace runstone {
namespace {

std::string visit_line(const char* what, const PlayerVisit& visit) {
  std::string line = with_field(what, "name", visit.name);
  line = with_field(std::move(line), "author", std::uint64_t{visit.author});
  return with_field(std::move(line), "key", key_fingerprint(visit.key));
}

}  // namespace

std::string came_line(const PlayerVisit& visit, const std::string& address) {
  std::string line = with_field(visit_line("came", visit), "address", address);
  line = with_field(std::move(line), "players", std::uint64_t{visit.players});
  return with_field(std::move(line), "session", std::uint64_t{visit.session});
}

std::string left_line(const PlayerVisit& visit, const EndCause& end) {
  std::string line =
      with_field(visit_line("left", visit), "reason", std::string_view(to_string(end.reason)));
  line = with_field(std::move(line), "why", end.text);
  line = with_field(std::move(line), "players", std::uint64_t{visit.players});
  return with_field(std::move(line), "session", std::uint64_t{visit.session});
}

}  // namespace runstone
