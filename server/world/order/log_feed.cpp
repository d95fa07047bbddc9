#include "server/world/order/log_feed.hpp"

#include <algorithm>
#include <utility>

namespace runstone {
namespace {

void add_rows(const std::vector<PlayerRow>& rows, LogPart& part) {
  for (const PlayerRow& row : rows) part.players.push_back({row.author, row.key, row.name});
}

/// Returns the number of records from `first` on that one message may hold.
std::size_t records_that_fit(const std::vector<EditRecord>& records, std::size_t first) {
  if (records.size() == first + 1) return 1;
  constexpr std::size_t kOverhead = 128;  // of a record besides its descriptor, at most
  std::size_t bytes = 0, count = 0;
  while (first + count < records.size() && count < kLogPartRecordsMax) {
    bytes += kOverhead + encode(records[first + count].edit).size();
    if (count > 0 && bytes > kLogPartBytesMax) break;
    ++count;
  }
  return count;
}

}  // namespace

void LogFeed::append(std::vector<PlayerRow> players, OrderedBatch& batch) {
  if (may_be_followed()) pass_on_batch(players, batch);
  environment_.log_append(std::move(players), std::move(batch.records));
}

void LogFeed::append_players(Epoch epoch, std::vector<PlayerRow> players) {
  if (may_be_followed()) {
    LogPart part;
    part.epoch = epoch;
    add_rows(players, part);
    pass_on(std::move(part));
  }
  environment_.log_append(std::move(players), {});
}

void LogFeed::append_names(Epoch epoch, std::vector<NameChange> changes) {
  if (may_be_followed()) {
    for (const auto& [claim, is_release] : changes) {
      LogPart part;
      part.epoch = epoch;
      part.names.push_back({claim.folded, claim.name, claim.key, is_release});
      pass_on(std::move(part));
    }
  }
  environment_.log_names(std::move(changes));
}

void LogFeed::pause_all() {
  for (auto& [link, receiver] : receivers_) receiver.gets_records = false;
}

bool LogFeed::is_served(SessionId link) const {
  const Receiver& receiver = receivers_.at(link);
  return receiver.gets_records && !receiver.is_full;
}

bool LogFeed::has_served() const {
  return std::ranges::any_of(receivers_, [](const auto& entry) {
    return entry.second.gets_records && !entry.second.is_full;
  });
}

bool LogFeed::send(SessionId link, const EncodedMessage& message) {
  Receiver& receiver = receivers_.at(link);
  if (!receiver.is_full) receiver.is_full = !environment_.send(link, message);
  return !receiver.is_full;
}

void LogFeed::send_to_served(const EncodedMessage& message, bool to_all) {
  for (auto& [link, receiver] : receivers_) {
    if (to_all || receiver.gets_records) send(link, message);
  }
}

void LogFeed::pass_on(LogPart part) {
  if (may_be_followed_) unwritten_.add(part);
  if (has_served()) send_to_served(encode_message(std::move(part)));
}

void LogFeed::pass_on_batch(const std::vector<PlayerRow>& players, const OrderedBatch& batch) {
  const std::vector<EditRecord>& records = batch.records;
  for (std::size_t first = 0; first < records.size();) {
    LogPart part;
    part.epoch = batch.commit.epoch;
    if (first == 0) add_rows(players, part);
    const std::size_t end = first + records_that_fit(records, first);
    for (; first < end; ++first)
      part.records.push_back({records[first], batch.commit.edits[first].submitted_us});
    pass_on(std::move(part));
  }
}

}  // namespace runstone
