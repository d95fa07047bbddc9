#include "server/runtime/activity_line.hpp"

#include <spdlog/fmt/fmt.h>

#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

std::string bytes_text(std::uint64_t bytes) {
  constexpr double kKb = 1e3, kMb = 1e6, kGb = 1e9;
  const auto value = static_cast<double>(bytes);
  if (value < kKb) return fmt::format("{} bytes", bytes);
  if (value < kMb) return fmt::format("{:.1f} KB", value / kKb);
  if (value < kGb) return fmt::format("{:.1f} MB", value / kMb);
  return fmt::format("{:.1f} GB", value / kGb);
}

/// Collects what moved.
class Moved {
 public:
  void count(std::uint64_t before, std::uint64_t after, const char* noun, const char* rest = "") {
    if (after > before) add(counted(after - before, noun) + rest);
  }
  void bytes(std::uint64_t before, std::uint64_t after, const char* what) {
    if (after > before) add(bytes_text(after - before) + " " + what);
  }
  const std::string& text() const { return text_; }

 private:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : ", ") + part; }
  std::string text_;
};

}  // namespace

ActivitySample sample_activity(const WorldServer& world, const NetCounters& net,
                               const LogWriter::Counters& log) {
  return {world.counters(),     net.malformed.load(), net.bytes_in.load(),
          net.bytes_out.load(), log.snapshots,        log.keyframes};
}

std::string activity_line(const ActivitySample& before, const ActivitySample& after,
                          const ActivityNow& now, std::uint64_t seconds) {
  const WorldCounters &a = before.world, &b = after.world;
  Moved moved;
  moved.count(a.sessions_opened, b.sessions_opened, "player", " came");
  moved.count(a.edits_ordered, b.edits_ordered, "edit");
  moved.count(a.edits_rejected, b.edits_rejected, "edit", " refused");
  moved.count(a.snapshots_sent, b.snapshots_sent, "chunk", " sent");
  moved.bytes(before.bytes_out, after.bytes_out, "sent");
  moved.bytes(before.bytes_in, after.bytes_in, "received");
  moved.count(before.snapshots, after.snapshots, "chunk", " saved");
  moved.count(before.keyframes, after.keyframes, "keyframe", " made");
  moved.count(a.queue_full, b.queue_full, "message", " beyond a full queue");
  moved.count(a.chunks_requested, b.chunks_requested, "chunk", " requested again");
  moved.count(before.malformed, after.malformed, "malformed message");
  moved.count(a.chunks_failed, b.chunks_failed, "chunk", " that cannot be read");
  moved.count(a.digest_mismatches, b.digest_mismatches, "wrong digest");
  if (moved.text().empty()) return "";
  return fmt::format("in {} s: {}; now {}, {} of world in memory", seconds, moved.text(),
                     counted(now.players, "player"), bytes_text(now.world_bytes));
}

}  // namespace runstone
