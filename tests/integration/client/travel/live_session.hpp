// LiveSession: a client session over a real connection, run by the test's thread.
#pragma once
#include <asio/io_context.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "client/net/key_file.hpp"
#include "client/net/link.hpp"
#include "client/session/client_session.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone::test {

class LiveSession final : private LinkCallbacks {
 public:
  LiveSession(std::uint16_t port, const View& view)
      : session_(config(view)), link_(io_, {.host = "127.0.0.1", .port = port}, *this) {
    link_.start();
  }
  ~LiveSession() override {
    is_leaving_ = true;
    link_.stop(0);
    io_.run_for(std::chrono::seconds(1));
  }

  ClientSession& session() { return session_; }
  Replica& replica() { return session_.replica(); }

  void pump() {
    session_.tick(steady_now_us());
    flush();
    io_.run_for(std::chrono::milliseconds(2));
    static_cast<void>(replica().drain_changes());
  }
  /// Requires `reached` to come true within 20 seconds.
  void until(const std::function<bool()>& reached) {
    const TimeUs end_us = steady_now_us() + 20'000'000;
    while (!reached()) {
      pump();
      REQUIRE(steady_now_us() < end_us);
    }
  }
  /// Waits until all of the view is here and no local edit is left.
  void catch_up() {
    until([&] { return session_.loaded() && replica().local_edits().all().empty(); });
  }
  void edit(const EditDescriptor& edit) {
    REQUIRE(session_.offer(edit, steady_now_us(), steady_now_us()).has_value());
  }
  /// Waits until the moment is here, or the request was refused.
  void travel(const HistoryRequest& travel) {
    REQUIRE(session_.request_history(travel).has_value());
    until([&] { return !session_.loading_history(); });
  }

 private:
  static SessionConfig config(const View& view) {
    SessionConfig config;
    config.keys = random_key();
    config.instance = random_instance();
    config.view = view;
    return config;
  }
  void flush() {
    for (const Message& message : session_.take_outgoing())
      link_.send(connection_, encode_message(message));
  }
  void on_connected(ConnectionNumber connection,
                    const std::optional<ChannelBinding>& binding) override {
    connection_ = connection;
    session_.connected(random_nonce(), binding, steady_now_us());
    flush();
  }
  void on_received(LinkReceived received) override {
    const TimeUs now_us = steady_now_us();
    session_.receive(std::move(received.message),
                     {received.received_us, received.unpacked_us, now_us});
  }
  void on_disconnected(ConnectionNumber /*connection*/, std::string why) override {
    if (!is_leaving_) FAIL_CHECK(why);
    session_.disconnected();
  }

  asio::io_context io_{1};
  ClientSession session_;
  Link link_;
  ConnectionNumber connection_ = 0;
  bool is_leaving_ = false;
};

}  // namespace runstone::test
