// SimClient: a ClientSession that connects, edits, moves its view and loses its connection, in
// virtual time.
#pragma once
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "client/cache/chunk_cache.hpp"
#include "client/session/client_session.hpp"
#include "tests/simulation/client/session/sim_server.hpp"

namespace runstone::test {

/// Connects with a server. Returns null if there is none.
using SimDial = std::function<std::shared_ptr<SimConnection>(SimEnd client)>;

class SimClient {
 public:
  SimClient(VirtualTime& time, SplitMix64& rng, SimDial dial, unsigned number)
      : time_(time), rng_(rng), dial_(std::move(dial)), number_(number), session_(config(number)) {
    pump();
  }
  /// Makes a client that caches chunks in this folder. It must not edit: restart() forgets local
  /// edits.
  SimClient(VirtualTime& time, SplitMix64& rng, SimDial dial, unsigned number,
            const std::string& cache_folder)
      : SimClient(time, rng, std::move(dial), number) {
    auto cache = ChunkCache::open(cache_folder, std::uint64_t{1} << 20);
    if (!cache) throw SimFault(cache.error());
    cache_ = *std::move(cache);
    session_ = ClientSession(config(number));
  }

  /// Kills the process and starts another one with the same cache.
  void restart() {
    const View view = session_.view();
    if (connection_) connection_->cut();
    connection_.reset();
    ++link_;
    ++life_;
    session_ = ClientSession(config(number_ + 1000 * life_));
    session_.set_view(view);
    retry_at_ = time_.now() + rng_.between(1'000, 300'000);
  }
  const ChunkCache* cache() const { return cache_.get(); }

  ClientSession& session() { return session_; }
  Replica& replica() { return session_.replica(); }

  /// Submits an edit and keeps it for the final check.
  void edit(const EditDescriptor& edit) {
    const auto seq = session_.offer(edit, time_.now(), time_.now());
    if (seq) submitted_[*seq] = edit;
    refused_ += replica().opened() && !seq ? 1 : 0;
  }
  void look(const View& view) { session_.set_view(view); }
  void cut() {
    if (connection_) connection_->cut();
  }

  ClientInstance instance() const { return instance_; }
  const std::map<ClientSequence, EditDescriptor>& submitted() const { return submitted_; }
  const std::map<ClientSequence, RejectReason>& rejected() const { return rejected_; }
  std::uint64_t refused() const { return refused_; }
  const std::set<ClientSequence>& durable() const { return durable_; }
  const std::set<ClientSequence>& unseen() const { return unseen_; }
  bool is_idle() {
    return session_.is_open() && session_.loaded() && replica().local_edits().all().empty() &&
           replica().awaiting_count() == 0;
  }

 private:
  SessionConfig config(unsigned number) {
    SessionConfig c;
    KeySeed seed{};
    seed[0] = static_cast<std::uint8_t>(number_);
    c.has_cache = cache_ != nullptr;
    c.keys = key_pair_of(seed);
    c.name = "replica " + std::to_string(number_);
    if (number % 2 == 0) c.features |= kFeatureNames;
    instance_ = c.instance = 1000 + number;
    c.encodings = number % 2 == 0 ? 1 : 2;
    c.view = {1, {0, 0, 0}, 2, 1};
    return c;
  }

  /// Runs every few milliseconds: connects if needed, ticks, sends messages, and drains the
  /// changes.
  void pump() {
    time_.after(rng_.between(1000, 8000), [this] {
      if (!connection_ && time_.now() >= retry_at_) connect();
      if (connection_) {
        session_.tick(time_.now());
        if (cache_) step_cache();
        for (const Message& message : session_.take_outgoing())
          connection_->send_from_client(encode_message(message));
        if (session_.wants_close()) close();
      }
      for (const RejectedEdit& r : drain_changes().rejects) rejected_[r.seq] = r.reason;
      pump();
    });
  }
  /// Answers cache lookups after a while, sometimes later than a view waits.
  void step_cache() {
    while (auto lookup = session_.take_cache_lookup()) {
      time_.after(rng_.between(100, 300'000), [this, life = life_, q = *std::move(lookup)] {
        if (life == life_) session_.receive_cache_result(cache_->find(q), time_.now());
      });
    }
    const auto world = session_.cached_world();
    if (world && rng_.below(50) == 0) cache_->keep(*world, session_.replica().take_for_cache(40));
  }
  ReplicaChanges drain_changes() {
    ReplicaChanges changes = replica().drain_changes();
    durable_.insert(changes.durable.begin(), changes.durable.end());
    unseen_.insert(changes.unseen.begin(), changes.unseen.end());
    return changes;
  }

  /// Closes a connection whose server says goodbye, or is silent.
  void close() {
    const SessionEnd& end = *session_.end();
    const bool is_expected = end.by_server ? !end.final : end.reason == GoodbyeReason::timed_out;
    if (!is_expected) throw SimFault("session closes: " + end.text);
    connection_->cut();
  }
  void connect() {
    ++link_;
    SimEnd end;
    end.on_message = [this](MessageKind kind, ByteView bytes) -> Result<void> {
      const std::uint16_t edge =
          session_.welcome() && session_.state() != SessionState::hello_sent ? kSimEdge : 0;
      auto message = decode_message(Sender::server, kind, bytes, edge);
      if (!message) throw SimFault(std::string("client cannot decode: ") + message.error().what);
      session_.receive(std::move(*message), {time_.now(), time_.now(), time_.now()});
      return {};
    };
    end.on_bad_stream = [](const Error& error) {
      throw SimFault(std::string("client got a bad stream: ") + error.what);
    };
    end.on_drained = [] {};
    end.on_closed = [this, link = link_] {
      if (link != link_ || !connection_) return;
      connection_.reset();
      session_.disconnected();
      retry_at_ = time_.now() + rng_.between(20'000, 500'000);
    };
    connection_ = dial_(std::move(end));
    if (!connection_) {
      retry_at_ = time_.now() + rng_.between(20'000, 500'000);
      return;
    }
    Nonce nonce{};
    for (auto& b : nonce) b = static_cast<std::uint8_t>(rng_.next());
    session_.connected(nonce, std::nullopt, time_.now());
  }

  VirtualTime& time_;
  SplitMix64& rng_;
  const SimDial dial_;
  const unsigned number_;
  std::unique_ptr<ChunkCache> cache_;
  unsigned life_ = 0;
  ClientInstance instance_ = 0;
  ClientSession session_;
  std::shared_ptr<SimConnection> connection_;
  std::uint64_t link_ = 0;
  TimeUs retry_at_ = 0;
  std::map<ClientSequence, EditDescriptor> submitted_;
  std::map<ClientSequence, RejectReason> rejected_;
  std::uint64_t refused_ = 0;  // by the client
  std::set<ClientSequence> durable_, unseen_;
};

}  // namespace runstone::test
