#include <utility>

#include "protocol/codec/body_reader.hpp"

namespace runstone {
namespace {

Result<void> take_chat_line(const wire::ChatLine& t, ChatLine& line) {
  if (t.kind() == 0) return bad("chat line: kind is 0");
  line.kind = static_cast<ChatLineKind>(t.kind());
  line.author = t.author();
  line.utc_us = t.utc_us();
  if (!is_time(line.utc_us)) return bad("chat line: time is out of range");
  if (!take_text(t.name(), 0, kPlayerNameBytesMax, line.name))
    return bad("chat line: name is not 0 .. 32 bytes of text");
  const bool is_of_player = line.kind == ChatLineKind::player;
  if (is_of_player ? !is_plain_name(line.name) : !line.name.empty() || line.author != 0)
    return bad("chat line: its kind and its name do not fit");
  if (!take_text(t.text(), 1, kChatBytesMax, line.text))
    return bad("chat line: text is not 1 .. 512 bytes of text");
  return {};
}

}  // namespace

Result<Message> BodyReader::read(const wire::ChatRequest& t) const {
  ChatRequest m;
  if (!take_text(t.text(), 1, kChatBytesMax, m.text))
    return bad("chat request is not 1 .. 512 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::ChatLines& t) const {
  const auto count = count_of(t.lines(), kChatLinesMax);
  if (!count || *count == 0) return bad("chat lines are not 1 .. 64");
  ChatLines m;
  m.lines.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (const auto ok = take_chat_line(*t.lines()->Get(i), m.lines[i]); !ok)
      return failure(ok.error());
  }
  return m;
}

Result<Message> BodyReader::read(const wire::ChatWithdrawn& t) const {
  const auto count = count_of(t.lines(), kChatWithdrawnMax);
  if (!count || *count == 0) return bad("withdrawn chat lines are not 1 .. 128");
  ChatWithdrawn m;
  m.lines.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    const wire::ChatLineId& from = *t.lines()->Get(i);
    ChatLineId& line = m.lines[i];
    line.utc_us = from.utc_us();
    if (!is_time(line.utc_us)) return bad("withdrawn chat line: time is out of range");
    const bool is_named = take_text(from.name(), 1, kPlayerNameBytesMax, line.name);
    if (!is_named || !is_plain_name(line.name))
      return bad("withdrawn chat line: name is not that of a player");
  }
  return m;
}

}  // namespace runstone
