#include "bench/servers/relay_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "bench/edits/stack_case.hpp"
#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/harness/strand_surroundings.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/world/world_server.hpp"

namespace runstone::bench {
namespace {

constexpr SessionId kPlayers = 20;  // at each server
constexpr SessionId kLink = 1'000;  // the other server's session at the owner
constexpr std::size_t kEdits = 10'000;
constexpr TimeUs kTickUs = 50'000;
constexpr std::size_t kEditsPerTick = 50;           // 1,000 a second
constexpr std::int32_t kSite = 24;                  // edits lie within so many voxels of a place
constexpr std::int32_t kApart = 300 * kStrandEdge;  // voxels between the two places

/// With wires to the other server.
class Linked final : public StrandSurroundings {
 public:
  std::deque<EncodedMessage> to_link, to_owner;

  bool send(SessionId session, const EncodedMessage& message) override {
    if (session != kLink) return StrandSurroundings::send(session, message);
    to_link.push_back(message);
    return true;
  }
  bool send_to_owner(const EncodedMessage& message) override {
    to_owner.push_back(message);
    return true;
  }
  void leave_owner(const std::string& why) override {
    fmt::print(stderr, "left the owner: {}\n", why);
    RUNSTONE_ASSERT(false);
  }
};

/// One of the servers.
struct Node {
  Linked outside;
  WorldServer server{strand_config(0), {}, outside, fill_constant};
  std::uint64_t ns = 0;  // that its strand and its codec have taken

  template <class Work>
  void timed(Work&& work) {
    const std::uint64_t start = core_ns();
    work();
    ns += core_ns() - start;
  }
};

class TwoServers {
 public:
  TwoServers() {
    other_.server.cluster().follow();
    owner_.server.connected(kLink, now_);
    other_.server.cluster().owner_connected(std::nullopt, now_);
    pass_messages();
    RUNSTONE_ASSERT(other_.server.cluster().is_live());
    for (SessionId player = 1; player <= kPlayers; ++player) {
      join(owner_, player, 0);
      join(other_, player, kApart);
    }
    settle();
  }

  struct Costs {
    double owner_us = 0, other_us = 0;  // of each edit
  };
  /// Edits of the players at the owner, or at the other server.
  Costs run(bool are_at_owner, std::size_t commit_edits) {
    owner_.ns = other_.ns = 0;
    SplitMix64 rng(1);
    const Sequence before = owner_.server.order().head();
    for (std::size_t i = 0; i < kEdits; ++i) {
      edit(are_at_owner ? owner_ : other_, 1 + static_cast<SessionId>(i % kPlayers),
           are_at_owner ? 0 : kApart, rng);
      if ((i + 1) % commit_edits == 0) commit();
      if ((i + 1) % kEditsPerTick == 0) tick();
    }
    tick();
    RUNSTONE_ASSERT(owner_.server.order().head() == before + kEdits);
    RUNSTONE_ASSERT(other_.server.order().head() == owner_.server.order().head());
    const auto us = [](const Node& node) { return static_cast<double>(node.ns) / 1000 / kEdits; };
    return {us(owner_), us(other_)};
  }

 private:
  void join(Node& node, SessionId player, std::int32_t x) {
    const KeyPair keys =
        key_pair_of({2, static_cast<std::uint8_t>(player), static_cast<std::uint8_t>(x != 0)});
    const std::string name = (x == 0 ? "here" : "there") + std::to_string(player);
    bench::join(node.server, node.outside, player, keys, name, 0, now_);
    pass_messages();
    View view;
    view.centre = {x / kStrandEdge, 0, 0};
    view.radius_h = 6;
    view.radius_v = 3;
    node.server.received(player, view, now_);
  }

  /// Passes messages between the servers until there are none.
  void pass_messages() {
    while (!other_.outside.to_owner.empty() || !owner_.outside.to_link.empty()) {
      pass(other_.outside.to_owner, Sender::client, owner_,
           [this](Message&& message) { owner_.server.received(kLink, std::move(message), now_); });
      pass(owner_.outside.to_link, Sender::server, other_, [this](Message&& message) {
        other_.server.cluster().owner_received(std::move(message), now_);
      });
    }
  }
  template <class Take>
  static void pass(std::deque<EncodedMessage>& wire, Sender sender, Node& to, Take&& take) {
    for (; !wire.empty(); wire.pop_front()) {
      to.timed([&] {
        auto message = decode_message(sender, wire.front().kind, *wire.front().bytes, kStrandEdge);
        RUNSTONE_ASSERT(message.has_value());
        take(*std::move(message));
      });
    }
  }

  void edit(Node& node, SessionId player, std::int32_t x, SplitMix64& rng) {
    const auto place = [&rng] { return rng.between(-kSite, kSite); };
    const EditDescriptor edit{
        SetVoxel{{x + place(), place(), place()}}, {}, static_cast<Material>(rng.below(8))};
    const EditRequest request{++sequence_[{&node, player}], 0, edit};
    node.timed([&] { node.server.received(player, request, now_); });
    now_.steady_us += kTickUs / kEditsPerTick;
    now_.utc_us += kTickUs / kEditsPerTick;
  }

  /// Brings the edits that wait to the owner, which orders them.
  void commit() {
    pass_messages();
    owner_.timed([this] { owner_.server.commit(now_); });
    pass_messages();
  }

  void tick() {
    commit();
    owner_.timed([this] {
      owner_.server.durable(owner_.server.order().head(), now_);
      owner_.server.tick(now_);
    });
    other_.timed([this] { other_.server.tick(now_); });
    pass_messages();
    answer(owner_);
    answer(other_);
  }

  /// Ticks until all chunks are there.
  void settle() {
    do {
      now_.steady_us += kTickUs;
      now_.utc_us += kTickUs;
      owner_.server.tick(now_);
      other_.server.tick(now_);
      pass_messages();
    } while (answer(owner_) + answer(other_) > 0);
  }

  /// Answers what the workers were asked for. Returns the number of chunks.
  std::size_t answer(Node& node) {
    std::size_t chunks = 0;
    for (; !node.outside.loads.empty(); ++chunks) {
      const ChunkKey key = node.outside.loads.front();
      node.outside.loads.pop_front();
      Chunk chunk = terrain_chunk(key.at);
      node.timed([&] { node.server.chunk_loaded(key, std::move(chunk), now_); });
    }
    node.timed([&] {
      while (node.server.ground().has_deliveries()) node.server.ground().deliver_next(now_);
    });
    return chunks;
  }

  Clocks now_{1'000'000, 1'000'000'000'000};
  std::map<std::pair<const Node*, SessionId>, ClientSequence> sequence_;
  Node owner_, other_;
};

}  // namespace

Result<std::vector<RelayRow>, std::string> run_relay_bench(const BenchOptions& options,
                                                           std::ostream& progress) {
  std::vector<RelayRow> rows;
  for (const std::size_t commit_edits : {std::size_t{1}, std::size_t{10}}) {
    TwoServers servers;
    std::array<std::vector<double>, 4> us;
    for (unsigned i = 0; i <= options.repetitions; ++i) {
      const TwoServers::Costs at_owner = servers.run(true, commit_edits);
      const TwoServers::Costs at_other = servers.run(false, commit_edits);
      if (i == 0) continue;  // the first repetition grows the buffers
      us[0].push_back(at_owner.owner_us);
      us[1].push_back(at_other.owner_us);
      us[2].push_back(at_other.other_us);
      us[3].push_back(at_owner.other_us);
    }
    rows.push_back({commit_edits, median(us[0]), median(us[1]), median(us[2]), median(us[3])});
    fmt::print(progress, "commits of {} edits\n", commit_edits);
  }
  return rows;
}

void write_table(const std::vector<RelayRow>& rows, std::ostream& out) {
  fmt::print(out,
             "| commits of | owner: edit of a player there | owner: edit of a player elsewhere | "
             "other server: edit of a player there | other server: edit of a player elsewhere "
             "|\n|---|---|---|---|---|\n");
  for (const RelayRow& row : rows) {
    fmt::print(out, "| {} | {:.1f} µs | {:.1f} µs | {:.1f} µs | {:.1f} µs |\n",
               row.commit_edits == 1 ? "1 edit" : fmt::format("{} edits", row.commit_edits),
               row.owner_local_us, row.owner_relayed_us, row.follower_local_us,
               row.follower_remote_us);
  }
}

void write_json(const std::vector<RelayRow>& rows, std::ostream& out) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RelayRow& row : rows) {
    json.push_back({{"commit_edits", row.commit_edits},
                    {"owner_local_us", row.owner_local_us},
                    {"owner_relayed_us", row.owner_relayed_us},
                    {"follower_local_us", row.follower_local_us},
                    {"follower_remote_us", row.follower_remote_us}});
  }
  out << json.dump(2) << '\n';
}

}  // namespace runstone::bench
