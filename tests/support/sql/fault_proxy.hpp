// FaultProxy: stands between libpq and a PostgreSQL server, and makes one statement fail: the
// connection is cut at a certain moment, or an error of the server comes in place of the answer.
//   - It listens on a Unix socket in a folder of its own, and has a thread for each connection.
//   - The begin of a connection counts as a statement. An error there ends the connection, as the
//     errors of PostgreSQL do.
//   - An error is true: the server itself has aborted the transaction, see WireRequest.
//   - When the client sees that a connection was cut, the session of the server has ended: its
//     transaction is rolled back, and its locks are free.
//   - A statement and its answer are in memory as a whole, so both must be small.
//   - It does not encrypt, so the server must accept connections without TLS.
// Threads: any.
#pragma once
#include <sys/socket.h>

#include <condition_variable>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/wire_message.hpp"
#include "tests/support/sql/wire_request.hpp"

namespace runstone::test {

struct ProxyFault {
  enum class Kind {
    cut_before,         // the statement does not reach the server
    cut_before_answer,  // the server has carried the request out, and no byte of its answer arrives
    cut_within_answer,  // half of the answer arrives
    cut_after_answer,   // all of the answer arrives
    error,              // an error arrives instead of the answer
    fatal               // like `error`, and the session ends
  };
  Kind kind = Kind::cut_before;
  std::string sqlstate = {}, text = {};  // of an error
  bool is_for_ever = false;              // every later statement fails, too

  /// Returns true if the fault is one of the answer. PostgreSQL gives one answer to a pipeline of
  /// statements, so such a fault counts requests, not statements.
  bool is_in_answer() const {
    return kind == Kind::cut_before_answer || kind == Kind::cut_within_answer ||
           kind == Kind::cut_after_answer;
  }
  bool is_error() const { return kind == Kind::error || kind == Kind::fatal; }
};

class FaultProxy {
 public:
  /// `url` is the address of the server. It must answer.
  explicit FaultProxy(const std::string& url);
  /// Cuts all connections.
  ~FaultProxy();
  FaultProxy(const FaultProxy&) = delete;
  FaultProxy& operator=(const FaultProxy&) = delete;

  /// Returns the address of a place on the same server, through this proxy. Requires that the address
  /// of the place has a `?`.
  std::string through(const std::string& place) const;

  /// Makes statement number `statement` from now, counted from 1, fail, or the request of that number
  /// if the fault is in the answer.
  void fail(std::uint64_t statement, const ProxyFault& fault);
  /// Lets every statement succeed from now on.
  void heal();
  /// Returns true if a statement has failed since the last fail().
  bool has_failed() const;
  /// Waits until the server has ended every session. Requires that every client has ended.
  void wait_for_ends();

 private:
  /// A connection: the sockets of the client and of the server, -1 after they were closed.
  struct Link {
    int client = -1, server = -1;
    std::thread thread = {};
    bool is_over = false;
  };
  /// A fault that strikes a request, at this statement of it.
  struct Strike {
    ProxyFault fault;
    std::size_t statement = 0;
  };

  void accept_links();
  /// Requires mutex_.
  void join_links_that_are_over();
  void serve(Link& link);
  /// Relays the begin of a session. Returns false if there is none.
  bool start_session(Link& link);
  /// Waits for the client. Forwards what the server says unasked. Returns false if the server has ended
  /// the session.
  bool wait_for_request(Link& link);
  /// Relays a request and its answer. Returns false if the connection is over.
  bool exchange(Link& link, const WireRequest& request);
  /// Forwards an answer, or the part of it that a fault lets through. Returns false if it cuts.
  bool forward_answer(Link& link, const std::vector<WireMessage>& answer,
                      const std::optional<Strike>& struck);
  std::optional<Strike> strike(std::size_t statements);
  bool connect_server(Link& link);
  /// Ends the session of the server and waits until it is over, then closes the client's socket.
  void cut(Link& link);
  void close(int& socket);

  const TempFolder folder_;
  sockaddr_storage server_{};
  socklen_t server_bytes_ = sizeof(server_);
  int listener_ = -1;

  mutable std::mutex mutex_;
  std::condition_variable ended_;  // a link is over
  // mutex_ guards the next members, the end of each link, and its sockets while they are closed.
  std::optional<ProxyFault> fault_;
  std::uint64_t left_ = 0;  // until the one that fails, included
  bool has_failed_ = false;
  bool is_ending_ = false;
  std::list<Link> links_;

  std::thread acceptor_;
};

}  // namespace runstone::test
