#include "protocol/codec/draw_answer.hpp"

#include <charconv>
#include <system_error>
#include <type_traits>

#include "common/core/text.hpp"

namespace runstone {
namespace {

std::string as_line(std::string text) {
  // The message of a driver may have several lines and any encoding.
  if (!is_printable_utf8(text)) {
    for (char& c : text) {
      if (c < ' ' || c > '~') c = ' ';
    }
  }
  return std::string(cut_utf8(text, kDrawAnswerBytesMax - 1)) + '\n';
}

bool take_word(std::string_view& line, std::string_view word) {
  if (!line.starts_with(word)) return false;
  line.remove_prefix(word.size());
  return true;
}

/// Reads a decimal number and the blank after it.
template <class T>
bool take_number(std::string_view& line, T& to) {
  const auto [end, wrong] = std::from_chars(line.data(), line.data() + line.size(), to);
  if (wrong != std::errc{} || end == line.data() + line.size() || *end != ' ') return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  return true;
}

}  // namespace

std::string to_line(const DrawAnswer& answer) {
  if (const auto* ready = std::get_if<DrawReady>(&answer)) {
    return as_line("ready " + std::to_string(ready->version) + " " + ready->renderer);
  }
  if (const auto* done = std::get_if<PictureDrawn>(&answer)) {
    return as_line("drawn quads=" + std::to_string(done->quads) +
                   " chunks=" + std::to_string(done->chunks) + " us=" + std::to_string(done->us) +
                   " " + done->file);
  }
  if (const auto* unwritten = std::get_if<PictureUnwritten>(&answer)) {
    return as_line("unwritten " + unwritten->text);
  }
  return as_line("error " + std::get<DrawFailed>(answer).text);
}

std::optional<DrawAnswer> parse_draw_answer(std::string_view line) {
  if (line.size() >= kDrawAnswerBytesMax || !is_printable_utf8(line)) return std::nullopt;
  if (take_word(line, "error ")) return DrawFailed{std::string(line)};
  if (take_word(line, "unwritten ")) return PictureUnwritten{std::string(line)};
  if (DrawReady ready; take_word(line, "ready ")) {
    if (!take_number(line, ready.version)) return std::nullopt;
    ready.renderer = line;
    return ready;
  }
  PictureDrawn done;
  if (!take_word(line, "drawn quads=") || !take_number(line, done.quads) ||
      !take_word(line, "chunks=") || !take_number(line, done.chunks) || !take_word(line, "us=") ||
      !take_number(line, done.us) || line.empty()) {
    return std::nullopt;
  }
  done.file = line;
  return done;
}

}  // namespace runstone
