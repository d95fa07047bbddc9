#include "tests/support/sql/fault_proxy.hpp"

#include <libpq-fe.h>
#include <poll.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

using Kind = ProxyFault::Kind;

constexpr const char* kSocketName = ".s.PGSQL.5432";  // libpq makes it of folder and port
constexpr int kLinksWaiting = 8;
// The values of the message AuthenticationRequest that a client does not answer.
constexpr int kAuthenticationOk = 0, kAuthenticationFinal = 12;

/// Reads the answer to a request, up to the message ReadyForQuery. It is shorter if the server ends the
/// session, or asks the client to prove who it is.
std::vector<WireMessage> read_answer(int server) {
  std::vector<WireMessage> answer;
  for (;;) {
    auto message = read_message(server);
    if (!message) return answer;
    answer.push_back(*std::move(message));
    const WireMessage& last = answer.back();
    const bool must_prove = last.type == 'R' && last.first_integer() != kAuthenticationOk &&
                            last.first_integer() != kAuthenticationFinal;
    if (last.type == 'Z' || must_prove) return answer;
  }
}

bool is_complete(const std::vector<WireMessage>& answer) {
  return !answer.empty() && answer.back().type == 'Z';
}

/// Puts an error in place of the one that the proxy has provoked, or of the end of a rollback.
void replace_error(std::vector<WireMessage>& answer, const ProxyFault& fault) {
  const WireMessage error = error_response("ERROR", fault.sqlstate, fault.text);
  auto found = std::find_if(answer.begin(), answer.end(),
                            [](const WireMessage& message) { return message.type == 'E'; });
  if (found == answer.end()) {
    found = std::find_if(answer.begin(), answer.end(),
                         [](const WireMessage& message) { return message.type == 'C'; });
  }
  RUNSTONE_ASSERT(found != answer.end());
  *found = error;
}

}  // namespace

FaultProxy::FaultProxy(const std::string& url) {
  PGconn* const connection = PQconnectdb(url.c_str());
  const int found =
      ::getpeername(PQsocket(connection), reinterpret_cast<sockaddr*>(&server_), &server_bytes_);
  PQfinish(connection);
  RUNSTONE_ASSERT(found == 0);

  sockaddr_un here{};
  here.sun_family = AF_UNIX;
  const std::string path = folder_ / kSocketName;
  RUNSTONE_ASSERT(path.size() < sizeof(here.sun_path));
  std::copy(path.begin(), path.end(), std::begin(here.sun_path));
  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int bound = ::bind(listener_, reinterpret_cast<const sockaddr*>(&here), sizeof(here));
  const int listens = ::listen(listener_, kLinksWaiting);
  RUNSTONE_ASSERT(bound == 0 && listens == 0);
  acceptor_ = std::thread([this] { accept_links(); });
}

FaultProxy::~FaultProxy() {
  {
    const std::lock_guard guard(mutex_);
    is_ending_ = true;
    ::shutdown(listener_, SHUT_RDWR);  // accept() returns
    for (const Link& link : links_) {
      for (const int socket : {link.client, link.server}) {
        if (socket >= 0) ::shutdown(socket, SHUT_RDWR);
      }
    }
  }
  acceptor_.join();
  for (Link& link : links_) link.thread.join();
  ::close(listener_);
}

std::string FaultProxy::through(const std::string& place) const {
  // libpq takes the last of several values.
  return place + "&host=" + folder_.path() + "&port=5432&sslmode=disable&gssencmode=disable";
}

void FaultProxy::fail(std::uint64_t statement, const ProxyFault& fault) {
  const std::lock_guard guard(mutex_);
  fault_ = fault;
  left_ = statement;
  has_failed_ = false;
}

void FaultProxy::heal() {
  const std::lock_guard guard(mutex_);
  fault_.reset();
}

bool FaultProxy::has_failed() const {
  const std::lock_guard guard(mutex_);
  return has_failed_;
}

void FaultProxy::wait_for_ends() {
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] {
    return std::all_of(links_.begin(), links_.end(), [](const Link& link) { return link.is_over; });
  });
}

std::optional<FaultProxy::Strike> FaultProxy::strike(std::size_t statements) {
  const std::lock_guard guard(mutex_);
  if (!fault_) return std::nullopt;
  if (has_failed_) return fault_->is_for_ever ? std::optional(Strike{*fault_, 0}) : std::nullopt;
  const std::size_t count = fault_->is_in_answer() ? 1 : statements;
  if (left_ > count) {
    left_ -= count;
    return std::nullopt;
  }
  has_failed_ = true;
  return Strike{*fault_, static_cast<std::size_t>(left_ - 1)};
}

void FaultProxy::accept_links() {
  for (;;) {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const std::lock_guard guard(mutex_);
    join_links_that_are_over();
    if (is_ending_ || client < 0) {
      if (client >= 0) ::close(client);
      return;
    }
    Link& link = links_.emplace_back();
    link.client = client;
    link.thread = std::thread([this, &link] { serve(link); });
  }
}

void FaultProxy::join_links_that_are_over() {
  links_.remove_if([](Link& link) {
    if (!link.is_over) return false;
    link.thread.join();
    return true;
  });
}

void FaultProxy::serve(Link& link) {
  bool goes_on = start_session(link);
  while (goes_on && wait_for_request(link)) {
    const auto request = WireRequest::read(link.client);
    goes_on = request && exchange(link, *request);
  }
  cut(link);
  const std::lock_guard guard(mutex_);
  link.is_over = true;
  ended_.notify_all();
}

bool FaultProxy::connect_server(Link& link) {
  const std::lock_guard guard(mutex_);
  if (is_ending_) return false;
  link.server = ::socket(server_.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  return ::connect(link.server, reinterpret_cast<const sockaddr*>(&server_), server_bytes_) == 0;
}

bool FaultProxy::start_session(Link& link) {
  const auto begin = read_untyped_message(link.client);
  if (!begin) return false;
  const auto struck = strike(1);
  if (struck && struck->fault.is_error()) {
    const ProxyFault& fault = struck->fault;
    send_bytes(link.client, error_response("FATAL", fault.sqlstate, fault.text).bytes());
    return false;
  }
  if (struck && struck->fault.kind == Kind::cut_before) return false;
  if (!connect_server(link) || !send_bytes(link.server, begin->bytes())) return false;
  for (;;) {
    const auto answer = read_answer(link.server);
    if (answer.empty() || answer.back().type != 'R') return forward_answer(link, answer, struck);
    if (!send_bytes(link.client, bytes_of(answer))) return false;
    const auto proof = read_message(link.client);
    if (!proof || !send_bytes(link.server, proof->bytes())) return false;
  }
}

bool FaultProxy::wait_for_request(Link& link) {
  for (;;) {
    std::array<pollfd, 2> wait = {pollfd{link.client, POLLIN, 0}, pollfd{link.server, POLLIN, 0}};
    if (::poll(wait.data(), wait.size(), -1) < 0) return false;
    if (wait[1].revents == 0) return true;
    const auto unasked = read_message(link.server);
    if (!unasked || !send_bytes(link.client, unasked->bytes())) return false;
  }
}

bool FaultProxy::exchange(Link& link, const WireRequest& request) {
  const std::size_t statements = request.statements();
  const auto struck = statements > 0 ? strike(statements) : std::nullopt;
  const auto kind = struck ? std::optional(struck->fault.kind) : std::nullopt;
  if (kind == Kind::cut_before || kind == Kind::fatal) {
    send_bytes(link.server, request.bytes_before(struck->statement));
    if (kind == Kind::fatal) {
      const ProxyFault& fault = struck->fault;
      send_bytes(link.client, error_response("FATAL", fault.sqlstate, fault.text).bytes());
    }
    return false;
  }
  const bool fails = kind == Kind::error;
  const std::string sent = fails ? request.failing_bytes(struck->statement) : request.bytes();
  if (!send_bytes(link.server, sent)) return false;
  auto answer = read_answer(link.server);
  if (fails && is_complete(answer)) replace_error(answer, struck->fault);
  return forward_answer(link, answer, struck);
}

bool FaultProxy::forward_answer(Link& link, const std::vector<WireMessage>& answer,
                                const std::optional<Strike>& struck) {
  std::string bytes = bytes_of(answer);
  const bool is_cut = struck && struck->fault.is_in_answer();
  if (is_cut && struck->fault.kind == Kind::cut_before_answer) return false;
  if (is_cut && struck->fault.kind == Kind::cut_within_answer) bytes.resize(bytes.size() / 2);
  return send_bytes(link.client, bytes) && !is_cut && is_complete(answer);
}

void FaultProxy::cut(Link& link) {
  if (link.server >= 0) {
    ::shutdown(link.server, SHUT_WR);
    // PostgreSQL closes the connection when its session has ended.
    while (read_message(link.server)) {
    }
  }
  close(link.server);
  close(link.client);
}

void FaultProxy::close(int& socket) {
  const std::lock_guard guard(mutex_);
  if (socket >= 0) ::close(socket);
  socket = -1;
}

}  // namespace runstone::test
