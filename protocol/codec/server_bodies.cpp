#include <memory>
#include <utility>

#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone {
namespace {

Result<void> take_player(const wire::LogPlayer& t, LogPlayer& player) {
  player.author = t.author();
  if (player.author == 0) return bad("log_part: authors start at 1");
  if (!take_exact(t.key(), player.key)) return bad("log_part: a key is not 32 bytes");
  if (!take_text(t.name(), 1, kPlayerNameBytesMax, player.name))
    return bad("log_part: a player's name is not 1 .. 32 bytes of text");
  return {};
}

Result<void> take_name(const wire::LogName& t, LogName& name) {
  if (!take_text(t.folded(), 1, kFoldedNameBytesMax, name.folded))
    return bad("log_part: a folded name is not 1 .. 512 bytes of text");
  if (!take_text(t.name(), 1, kPlayerNameBytesMax, name.name))
    return bad("log_part: a name is not 1 .. 32 bytes of text");
  if (!take_exact(t.key(), name.key)) return bad("log_part: a key is not 32 bytes");
  name.is_release = t.release();
  return {};
}

Result<void> take_record(const wire::LogRecordBytes& t, LogPartRecord& part) {
  auto record = decode_record(view_of(t.record()));
  if (!record) return failure(record.error());
  part.record = *std::move(record);
  part.submitted_us = t.submitted_us();
  if (!is_time(part.submitted_us)) return bad("log_part: a time is out of range");
  return {};
}

/// Reads a vector of tables, each by `take`.
template <class Vector, class Value, class Take>
Result<void> take_all(const Vector* from, std::size_t count_max, std::vector<Value>& to,
                      const Take& take) {
  const auto count = count_of(from, count_max);
  if (!count) return bad("log_part has too many entries");
  to.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (auto taken = take(*from->Get(i), to[i]); !taken) return taken;
  }
  return {};
}

Result<void> check_order(const LogPart& part) {
  for (std::size_t i = 0; i < part.records.size(); ++i) {
    const Version version = part.records[i].record.version;
    if (version.epoch > part.epoch) return bad("log_part: a record is of a later epoch");
    if (i == 0) continue;
    const Version before = part.records[i - 1].record.version;
    if (version.seq != before.seq + 1 || version.epoch < before.epoch)
      return bad("log_part: its records have a gap");
  }
  return {};
}

}  // namespace

bool operator==(const Relay& a, const Relay& b) {
  return a.sessions == b.sessions && a.message.kind == b.message.kind &&
         *a.message.bytes == *b.message.bytes;
}

Result<Message> BodyReader::read(const wire::FollowRequest& t) const {
  FollowRequest m{{t.epoch(), t.seq()}};
  if (m.after.seq > kSequenceMax) return bad("follow request: sequence exceeds 63 bits");
  const auto take_address = [](const flatbuffers::String* from, std::string& to) {
    return take_text(from, 0, kServerAddressBytesMax, to);
  };
  if (!take_address(t.player_address(), m.player_address) ||
      (!m.player_address.empty() && !is_player_address(m.player_address)))
    return bad("follow request: player_address is not HOST:PORT");
  if (!take_address(t.page_address(), m.page_address) || !is_page_address(m.page_address))
    return bad("follow request: page_address is not the address of a page");
  return m;
}

Result<Message> BodyReader::read(const wire::FollowAnswer& t) const {
  if (t.head() > kSequenceMax) return bad("follow answer: sequence exceeds 63 bits");
  return FollowAnswer{t.head()};
}

Result<Message> BodyReader::read(const wire::LogPart& t) const {
  LogPart m;
  m.epoch = t.epoch();
  if (m.epoch == 0) return bad("log_part: epoch is 0");
  auto taken = take_all(t.players(), kLogPartRowsMax, m.players, take_player);
  if (taken) taken = take_all(t.names(), kLogPartRowsMax, m.names, take_name);
  if (taken) taken = take_all(t.records(), kLogPartRecordsMax, m.records, take_record);
  if (taken) taken = check_order(m);
  if (!taken) return failure(taken.error());
  return Message{std::move(m)};
}

Result<Message> BodyReader::read(const wire::RelayOpen& t) const {
  RelayOpen m;
  m.session = t.session();
  m.address = t.address();
  m.is_encrypted = t.encrypted();
  if (!take_exact(t.key(), m.key)) return bad("relay_open.key is not 32 bytes");
  m.instance = t.instance();
  if (!take_text(t.name(), 1, kPlayerNameBytesMax, m.name))
    return bad("relay_open.name is not 1 .. 32 bytes of text");
  m.features = t.features();
  m.author = t.author();
  if (!take_pose(t.pose(), m.pose)) return bad("relay_open: pose is missing or outside the world");
  if (t.ticket() != nullptr && !take_text(t.ticket(), 1, kTicketBytesMax, m.ticket))
    return bad("relay_open.ticket is not 1 .. 128 bytes of text");
  if (t.password_key() != nullptr && !take_exact(t.password_key(), m.password_key.emplace()))
    return bad("relay_open.password_key is not 32 bytes");
  return m;
}

Result<Message> BodyReader::read(const wire::Relay& t) const {
  Relay m;
  const auto count = count_of(t.sessions(), kRelaySessionsMax);
  if (!count || *count == 0) return bad("relay is for no session, or for too many");
  m.sessions.assign(t.sessions()->begin(), t.sessions()->end());
  if (t.kind() == 0 || t.kind() > kMessageKindCount) return bad("relay: kind is unknown");
  m.message.kind = static_cast<MessageKind>(t.kind()) - 1;
  const ByteView body = view_of(t.body());
  m.message.bytes = std::make_shared<const Bytes>(body.begin(), body.end());
  return m;
}

Result<Message> BodyReader::read(const wire::RelayClose& t) const {
  RelayClose m;
  m.session = t.session();
  m.reason = t.reason();
  if (m.reason == 0 || m.reason > kGoodbyeReasonMax) return bad("relay_close: reason is unknown");
  if (!take_text(t.text(), 0, kTextBytesMax, m.text))
    return bad("relay_close.text is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::RelayCharge& t) const {
  return RelayCharge{t.session(), t.bytes()};
}

}  // namespace runstone
