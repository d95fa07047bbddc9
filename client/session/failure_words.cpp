#include "client/session/failure_words.hpp"

namespace runstone {
namespace {

const char* headline_of(const SessionEnd& end) {
  switch (end.reason) {
    case GoodbyeReason::closing:
      return end.by_server ? "The server has closed" : "The connection was closed";
    case GoodbyeReason::wrong_protocol:
      return "Server and client are of different versions";
    case GoodbyeReason::not_authenticated:
      return end.by_server ? "The server does not accept this identity"
                           : "This is not the server that you know";
    case GoodbyeReason::already_connected:
      return "You are connected a second time";
    case GoodbyeReason::server_full:
      return "The server is full";
    case GoodbyeReason::timed_out:
      return "The server stopped answering";
    case GoodbyeReason::flooding:
      return "The server closed the connection, because it got too much at once";
    case GoodbyeReason::name_refused:
      return "The server refuses this name";
    case GoodbyeReason::not_admitted:
      return "The server does not admit you";
    default:
      return end.by_server ? "The server closed the connection" : "The server made a mistake";
  }
}

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

}  // namespace

FailureWords words_of(const SessionEnd& end) { return {headline_of(end), end.text}; }

FailureWords words_of_link(std::string_view why, const std::string& address) {
  const std::string detail(why);
  if (why.empty()) return {"No answer yet from " + address, ""};
  if (why.starts_with("cannot resolve")) return {"There is no computer with this name", detail};
  if (has(why, "Connection refused")) return {"No server listens at " + address, detail};
  if (has(why, "Operation canceled") || has(why, "timed out") || has(why, "No route to host") ||
      has(why, "Network is unreachable")) {
    return {"No answer from " + address, detail};
  }
  if (why.starts_with("cannot connect")) return {"No connection to " + address, detail};
  if (has(why, "does not speak TLS"))
    return {"The server at " + address + " does not encrypt, or is no Runstone server", detail};
  if (why.starts_with("TLS: ")) return {"No encrypted connection to " + address, detail};
  if (why.starts_with("bad bytes")) return {"This is no Runstone server, or it is broken", detail};
  return {"The connection to " + address + " is lost", detail};
}

}  // namespace runstone
