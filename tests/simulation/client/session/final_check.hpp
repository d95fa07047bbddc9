// FinalCheck: what must hold when a simulation has come to rest. It shares no code with the code
// under test: the dense per-voxel oracle replays the log.
#pragma once
#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/simulation/client/session/sim_client.hpp"
#include "tests/simulation/client/session/sim_server.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {

/// The result of the final check. Each fault is one line.
struct FinalCheck {
  std::vector<std::string> faults;
  std::uint64_t edits = 0, chunks = 0, rejected = 0;
  std::uint64_t beyond = 0;   // refused by the clients: outside of the world's heights
  std::uint64_t unknown = 0;  // rejected by a server that died before it could answer: unseen

  using Clients = std::vector<std::unique_ptr<SimClient>>;

  void expect(bool ok, const std::string& fault) {
    if (!ok) faults.push_back(fault);
  }
  /// Returns the first faults, a line each.
  std::string text() const {
    std::string out;
    for (std::size_t i = 0; i < faults.size() && i < 10; ++i) out += faults[i] + "\n";
    return out;
  }

  /// Checks that edits that were durable earlier are in the log, at the same sequence.
  void check_durable_kept(const std::vector<EditRecord>& log,
                          const std::vector<OperationId>& durable) {
    expect(log.size() >= durable.size(), "durable edits are missing");
    for (std::size_t i = 0; i < std::min(log.size(), durable.size()); ++i)
      expect(log[i].op == durable[i], "a durable edit changed, seq " + std::to_string(i + 1));
  }

  /// Checks that each submitted edit is in the log once, or that its client knows why not.
  void check_exactly_once(const std::vector<EditRecord>& log, const Clients& clients) {
    std::map<OperationId, int> times;
    for (const EditRecord& record : log) ++times[record.op];
    for (const auto& [op, count] : times) expect(count == 1, "an edit was applied twice");
    for (const auto& client : clients) {
      for (const auto& [seq, edit] : client->submitted()) {
        const auto found = times.find({client->session().author(), client->instance(), seq});
        const auto reject = client->rejected().find(seq);
        const bool is_rejected =
            reject != client->rejected().end() || client->unseen().contains(seq);
        unknown += client->unseen().contains(seq) && found == times.end() ? 1 : 0;
        rejected += is_rejected ? 1 : 0;
        expect(found != times.end() || is_rejected,
               "an edit was lost without an answer, client seq " + std::to_string(seq));
        expect(found == times.end() || reject == client->rejected().end(),
               "an edit was rejected and applied, client seq " + std::to_string(seq));
        expect(found != times.end() || !client->durable().contains(seq),
               "an edit called durable is not in the log");
      }
    }
  }

  /// Checks that no edit beyond the world's heights was ordered, and that the clients refused all
  /// of them.
  void check_heights(const std::vector<EditRecord>& log, const HeightLimits& heights,
                     const Clients& clients) {
    for (const EditRecord& record : log) {
      const VoxelBox box = bounding_box(record.edit);
      expect(box.min.y >= heights.y_min && box.max.y <= heights.y_max,
             "an edit beyond the heights is in the log");
    }
    for (const auto& client : clients) {
      beyond += client->refused();
      for (const auto& [seq, reason] : client->rejected()) {
        expect(reason != RejectReason::outside_world,
               "a client predicted an edit beyond the heights");
      }
    }
  }

  /// Checks that servers, replicas and the dense replay of the log agree, chunk by chunk.
  void check_voxels(const std::vector<EditRecord>& log, const std::vector<WorldServer*>& worlds,
                    const Clients& clients) {
    std::map<ChunkKey, std::vector<EditDescriptor>> edits_of;
    std::map<ChunkKey, Sequence> versions;
    for (const EditRecord& record : log) {
      for (const ChunkCoord at : touched_chunks(record.edit, kSimEdge)) {
        edits_of[{0, at}].push_back(record.edit);
        versions[{0, at}] = record.version.seq;
      }
    }
    for (const auto& client : clients) {
      for (const ChunkKey& key : client->replica().confirmed_keys()) edits_of.try_emplace(key);
    }
    for (const auto& [key, stack] : edits_of) {
      ++chunks;
      DenseChunk oracle = DenseChunk::of(sim_base_chunk(key.at));
      oracle_apply(oracle, origin_of(key.at, kSimEdge), stack);
      const Digest expected = oracle.digest();
      const std::string name = "chunk " + std::to_string(key.at.x) + "," +
                               std::to_string(key.at.y) + "," + std::to_string(key.at.z);
      for (const WorldServer* world : worlds) {
        const ChunkPtr live = world->order().chunks().find(key);
        if (!live) continue;
        expect(digest_of(live->voxels) == expected, name + ": a server differs from the log");
        expect(live->digest == expected,
               name + ": the digest of a server does not follow its voxels");
      }
      for (const auto& client : clients) {
        const ChunkPtr held = client->replica().confirmed(key);
        if (!held) continue;
        expect(digest_of(held->voxels) == expected, name + ": replica " +
                                                        std::to_string(client->session().author()) +
                                                        " differs from the log");
        expect(held->version.seq == versions[key],
               name + ": a replica stands at version " + std::to_string(held->version.seq) +
                   ", and not at " + std::to_string(versions[key]));
        expect(*client->replica().shown(key) == held->voxels,
               name + ": something is shown that nobody confirmed");
      }
    }
  }
};

}  // namespace runstone::test
