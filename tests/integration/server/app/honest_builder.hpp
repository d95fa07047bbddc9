// HonestBuilder: a client that builds while its server dies again and again. It stays below its
// edit budget, remembers which of its edits the server reported as durable, and offers all others
// again to the next server. audit() looks for the durable edits in the log.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <iterator>
#include <map>
#include <memory>
#include <set>

#include "server/store/store.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

class HonestBuilder {
 public:
  /// Connects to a server that has just started. Requires that the server lets the client in.
  void join(std::uint16_t port) {
    client_ = std::make_unique<RawClient>(port);
    REQUIRE(client_->binding().has_value());  // TLS
    const auto accepted = client_->join(kKey, kInstance);
    REQUIRE(accepted.has_value());
    author_ = accepted->author;
    ordered_.erase(ordered_.upper_bound(durable_), ordered_.end());
    next_ = ordered_.empty() ? 1 : ordered_.rbegin()->second.seq + 1;
    answered_ = next_ - 1;
  }
  /// Offers again what may be lost, and builds a voxel each millisecond: for `time`, and on until
  /// an edit of this builder and one of another client are known to be durable, at most kPatience. At
  /// most kUnansweredMax edits wait for an answer. Otherwise a server that orders fewer than a
  /// thousand a second would be sent more in each cycle, and each cycle would last longer.
  void build(std::chrono::milliseconds time) {
    using std::chrono::steady_clock;
    const auto begin = steady_clock::now();
    const ClientSequence offered = offered_;
    for (auto now = begin; client_->is_open(); now = steady_clock::now()) {
      if (now >= begin + (has_durable_edits() ? time : kPatience)) break;
      const auto elapsed = std::chrono::duration_cast<std::chrono::milliseconds>(now - begin);
      const ClientSequence due = offered + 1 + static_cast<ClientSequence>(elapsed.count());
      for (; next_ <= std::min(due, answered_ + kUnansweredMax); ++next_)
        client_->send(EditRequest{next_, 0, edit_of(next_)});
      offered_ = std::max(offered_, next_ - 1);
      if (const auto message = client_->next(kReadMs)) take(*message);
    }
  }
  /// Reads what the server sent before it died.
  void read_rest() {
    while (const auto message = client_->next()) take(*message);
    client_.reset();
  }

  /// Returns the highest sequence that was reported as durable.
  Sequence durable() const { return durable_; }

  struct Audit {
    std::uint64_t lost = 0;      // durable edits that the log lacks or has changed
    std::uint64_t repeated = 0;  // operations that the log holds once more
    std::uint64_t mine = 0;      // edits of this builder that became durable since the last audit
    std::uint64_t others = 0;    // edits of other clients that did
    std::string error;           // why the log cannot be read; empty: it was read
  };
  /// Compares the log of a world that no server runs with what was reported as durable. Edits that a
  /// compaction has moved into the base are not compared.
  Audit audit(const std::string& folder) {
    Audit found;
    const auto store = open_world(folder, StoreAccess::read_only);
    if (!store) return {durable_, 0, 0, 0, store.error().message()};
    const auto last = (*store)->last_sequence();
    if (!last) return {durable_, 0, 0, 0, last.error().message()};
    if (*last < durable_) found.lost = durable_ - *last;
    std::set<OperationId> seen;
    const auto read = (*store)->read_log(1, *last, [&](const EditRecord& record) {
      if (!seen.insert(record.op).second) ++found.repeated;
      const bool is_new = record.version.seq > audited_ && record.version.seq <= durable_;
      if (is_new && record.op.instance != kInstance) ++found.others;
      const auto mine = ordered_.find(record.version.seq);
      if (mine == ordered_.end() || mine->first > durable_) return true;
      if (is_new) ++found.mine;
      if (record.op != mine->second || record.edit != edit_of(record.op.seq)) ++found.lost;
      return true;
    });
    if (!read) found.error = read.error().message();
    audited_ = durable_;
    return found;
  }

 private:
  static constexpr std::uint8_t kKey = 1;
  static constexpr ClientInstance kInstance = 33;
  static constexpr int kReadMs = 2;
  static constexpr ClientSequence kUnansweredMax = 500;
  // A slow machine under attack may need seconds for the first commit.
  static constexpr std::chrono::milliseconds kPatience{60'000};

  /// Each edit sets another voxel near the origin.
  static EditDescriptor edit_of(ClientSequence seq) {
    const auto n = static_cast<std::int32_t>(seq);
    return {SetVoxel{{n % 64, n / 4096, n / 64 % 64}}, {}, static_cast<Material>(1 + seq % 5)};
  }

  bool has_durable_edits() const {
    const auto end = ordered_.upper_bound(durable_);
    const auto mine = static_cast<Sequence>(std::distance(ordered_.begin(), end));
    return 0 < mine && mine < durable_;
  }

  void take(const Message& message) {
    if (const auto* durable = std::get_if<Durable>(&message)) durable_ = durable->seq;
    if (const auto* reject = std::get_if<Reject>(&message))
      answered_ = std::max(answered_, reject->client_seq);
    const auto* commit = std::get_if<Commit>(&message);
    if (commit == nullptr) return;
    for (const OrderedEdit& edit : commit->edits) {
      if (edit.op.author != author_) continue;
      ordered_[edit.seq] = edit.op;
      answered_ = std::max(answered_, edit.op.seq);
    }
  }

  std::unique_ptr<RawClient> client_;
  AuthorId author_ = 0;
  ClientSequence next_ = 1;      // the next one to send
  ClientSequence offered_ = 0;   // the last one that was ever sent
  ClientSequence answered_ = 0;  // the last one that was ordered or rejected
  Sequence durable_ = 0;
  Sequence audited_ = 0;                     // durable_ at the last audit
  std::map<Sequence, OperationId> ordered_;  // this builder's edits in the log
};

}  // namespace runstone::test
