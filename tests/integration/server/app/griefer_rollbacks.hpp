// GrieferRollbacks: a griefer builds, and the host rolls that back, again and again while the server
// dies. audit() looks in the log for the rollbacks that were answered as done.
#pragma once
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "server/admin/control_program.hpp"
#include "server/store/store.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

class GrieferRollbacks {
 public:
  /// `world`: the folder.
  explicit GrieferRollbacks(std::string world) : world_(std::move(world)) {}

  /// Builds and rolls back until `is_over` or the server's end. Thread: any, one at a time.
  void work(std::uint16_t port, const std::atomic<bool>& is_over) {
    RawClient griefer(port, kAddress);
    const auto accepted = griefer.join(kKey, ++instance_);
    if (!accepted) return;
    const std::string author = "#" + std::to_string(accepted->author);
    ClientSequence seq = 0;
    while (!is_over && griefer.is_open()) {
      for (int n = 0; n < kEdits; ++n) griefer.send(EditRequest{++seq, 0, edit_of(seq)});
      if (!sees_commit_of(griefer, seq, accepted->author, is_over)) return;
      const auto preview = give({"rollback", "preview", "author", author});
      if (!preview) {  // the budget is used up, or the edits are not on disk yet
        std::this_thread::sleep_for(std::chrono::milliseconds(kPauseMs));
        continue;
      }
      const std::string id = word_after(*preview, "`rollback apply ");
      const auto applied = give({"rollback", "apply", id});
      if (!applied) continue;
      ++answered_;
      const std::string first = word_after(*applied, "`rollback undo ");
      Sequence number = 0;
      std::from_chars(first.data(), first.data() + first.size(), number);
      if (number != 0) unchecked_.insert(number);
    }
  }
  /// Returns the number of rollbacks that were answered as done since the last call and that the log
  /// lacks. Requires that no server runs the world. Thread: that of the test.
  std::uint64_t audit() {
    const auto store = open_world(world_, StoreAccess::read_only);
    if (!store) return unchecked_.size();
    std::set<Sequence> found;
    for (const Sequence seq : unchecked_) {
      const auto read = (*store)->read_log(seq, seq, [&](const EditRecord& record) {
        if (record.cause == Cause::rollback) found.insert(record.version.seq);
        return true;
      });
      if (!read) return unchecked_.size();
    }
    return std::exchange(unchecked_, {}).size() - found.size();
  }
  std::uint64_t answered() const { return answered_; }
  /// Returns the number of commands that the death of a server cut.
  std::uint64_t cut() const { return cut_; }

 private:
  static constexpr std::uint32_t kAddress = INADDR_LOOPBACK + 60;
  static constexpr std::uint8_t kKey = 60;
  static constexpr int kEdits = 20, kPauseMs = 20, kReadMs = 100;

  /// Each edit sets another voxel, far from all others.
  static EditDescriptor edit_of(ClientSequence seq) {
    const auto n = static_cast<std::int32_t>(seq);
    return {SetVoxel{{n % 64, 80 + n / 64 % 64, -5'000}}, {}, static_cast<Material>(1 + seq % 5)};
  }
  /// Reads until the last of the griefer's edits is ordered or rejected. Returns false if the server
  /// ends before, or `is_over`: other messages may arrive without end.
  static bool sees_commit_of(RawClient& griefer, ClientSequence seq, AuthorId author,
                             const std::atomic<bool>& is_over) {
    while (!is_over && griefer.is_open()) {
      const auto message = griefer.next(kReadMs);
      if (!message) continue;
      if (const auto* reject = std::get_if<Reject>(&*message); reject && reject->client_seq == seq)
        return true;
      const auto* commit = std::get_if<Commit>(&*message);
      if (commit == nullptr) continue;
      for (const OrderedEdit& edit : commit->edits) {
        if (edit.op.author == author && edit.op.seq == seq) return true;
      }
    }
    return false;
  }
  /// Gives a command. Returns its answer, or nullopt if the server ended before or refused it.
  std::optional<std::string> give(const std::vector<std::string>& words) {
    std::ostringstream out;
    const auto end = control_server({world_, words}, out);
    if (!end) ++cut_;
    if (!end || *end != ControlEnd::done) return std::nullopt;
    return out.str();
  }
  /// Returns what stands between `before` and the next backquote.
  static std::string word_after(const std::string& text, std::string_view before) {
    const std::size_t at = text.find(before);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + before.size();
    return text.substr(begin, text.find('`', begin) - begin);
  }

  const std::string world_;
  ClientInstance instance_ = 0;
  std::set<Sequence> unchecked_;  // the first edits of rollbacks
  std::uint64_t answered_ = 0, cut_ = 0;
};

}  // namespace runstone::test
