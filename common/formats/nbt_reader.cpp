#include "common/formats/nbt_reader.hpp"

#include <algorithm>
#include <array>

namespace runstone {
namespace {

/// The bytes of a value of each type, or of one element of an array. 0: the value has no fixed size.
constexpr std::array<std::uint8_t, 13> kNbtWidths = {0, 1, 2, 4, 8, 4, 8, 0, 0, 0, 0, 0, 0};
/// The least bytes that a value of each type takes.
constexpr std::array<std::uint8_t, 13> kNbtLeastBytes = {0, 1, 2, 4, 8, 4, 8, 4, 2, 5, 1, 4, 4};

std::size_t index_of(NbtType type) { return static_cast<std::size_t>(type); }

/// A compound or a list whose end skip() has not reached.
struct OpenValue {
  NbtType type;  // compound, or the type of the elements of a list
  bool is_list;
  std::uint32_t left;  // elements of a list
};

unsigned low_bits(char c) { return static_cast<unsigned char>(c) & 63u; }
bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }

/// Returns true if three bytes of a surrogate begin at `at`. The upper ones of a pair have a second byte
/// of 0xa0 to 0xaf, the lower ones of 0xb0 to 0xbf.
bool is_surrogate(std::string_view text, std::size_t at, unsigned second) {
  return text.size() - at >= 3 && static_cast<unsigned char>(text[at]) == 0xed &&
         (static_cast<unsigned char>(text[at + 1]) & 0xf0u) == second &&
         is_continuation(text[at + 2]);
}

void put_surrogate(std::string& out, unsigned unit) {
  out.push_back(static_cast<char>(0xed));
  out.push_back(static_cast<char>(0x80u | (unit >> 6 & 63u)));
  out.push_back(static_cast<char>(0x80u | (unit & 63u)));
}

}  // namespace

void NbtReader::reject(ErrorCode code, const char* what) { reject(Error{code, what, offset()}); }

void NbtReader::reject(const Error& error) {
  if (failed_) return;
  failed_ = true;
  error_ = error;
  base_ = offset();
  in_ = {};
  at_ = 0;
  source_ = nullptr;
}

bool NbtReader::refill(std::size_t count, const char* what) {
  while (source_ != nullptr && in_.size() - at_ < count) {
    const ByteView rest = in_.subspan(at_);
    const auto next = source_->more(rest);
    if (!next) {
      reject(next.error());
      return false;
    }
    if (next->size() == rest.size()) break;
    base_ += at_;
    in_ = *next;
    at_ = 0;
  }
  if (in_.size() - at_ >= count && !failed_) return true;
  reject(ErrorCode::truncated, what);
  return false;
}

std::string_view NbtReader::root() {
  const std::uint8_t* type = take(1, "nbt: no bytes");
  if (type == nullptr) return {};
  if (*type != static_cast<std::uint8_t>(NbtType::compound)) {
    reject(ErrorCode::bad_value, "nbt: the outermost value is no compound");
    return {};
  }
  return string();
}

bool NbtReader::next(NbtEntry& entry) {
  const std::uint8_t* at = take(1, "nbt: a compound has no end");
  if (at == nullptr || *at == 0) return false;
  if (*at >= kNbtTypes) {
    reject(ErrorCode::bad_value, "nbt: an entry has an unknown type");
    return false;
  }
  entry.type = static_cast<NbtType>(*at);
  entry.name = string();
  return !failed_;
}

std::int64_t NbtReader::integer(NbtType type, const char* what) {
  switch (type) {
    case NbtType::i8:
      return i8();
    case NbtType::i16:
      return i16();
    case NbtType::i32:
      return i32();
    case NbtType::i64:
      return i64();
    default:
      reject(ErrorCode::bad_value, what);
      return 0;
  }
}

std::string_view NbtReader::string() {
  constexpr const char* kWhat = "nbt: a name or a string ends early";
  const std::uint8_t* head = take(2, kWhat);
  if (head == nullptr) return {};
  const std::size_t size = big_endian_at<std::uint16_t>(head);
  const std::uint8_t* at = take(size, kWhat);
  return at != nullptr ? std::string_view(reinterpret_cast<const char*>(at), size)
                       : std::string_view();
}

std::uint32_t NbtReader::array_head() {
  const std::int32_t count = i32();
  if (count >= 0) return static_cast<std::uint32_t>(count);
  reject(ErrorCode::bad_value, "nbt: an array has a negative length");
  return 0;
}

ByteView NbtReader::array(std::size_t width) { return bytes(width * array_head()); }

NbtList NbtReader::list() {
  const std::uint8_t* head = take(5, "nbt: the head of a list ends early");
  if (head == nullptr) return {};
  const auto count = big_endian_at<std::int32_t>(head + 1);
  if (*head >= kNbtTypes) {
    reject(ErrorCode::bad_value, "nbt: a list has an unknown type");
    return {};
  }
  const auto type = static_cast<NbtType>(*head);
  if (count < 0 || (count > 0 && type == NbtType::end)) {
    reject(ErrorCode::bad_value, "nbt: a list has a negative length, or values without a type");
    return {};
  }
  const NbtList list{type, static_cast<std::uint32_t>(count)};
  const std::uint64_t least = std::uint64_t{list.count} * kNbtLeastBytes[index_of(type)];
  if (source_ == nullptr && least > in_.size() - at_) {
    reject(ErrorCode::truncated, "nbt: a list has more values than bytes are left");
    return {};
  }
  return list;
}

void NbtReader::skip_bytes(std::uint64_t count) {
  while (!failed_) {
    const auto here = static_cast<std::size_t>(std::min<std::uint64_t>(count, in_.size() - at_));
    at_ += here;
    count -= here;
    if (count == 0) return;
    refill(1, "nbt: an array ends early");
  }
}

void NbtReader::skip_flat(NbtType type) {
  switch (type) {
    case NbtType::byte_array:
      skip_bytes(array_head());
      break;
    case NbtType::int_array:
      skip_bytes(std::uint64_t{array_head()} * 4);
      break;
    case NbtType::long_array:
      skip_bytes(std::uint64_t{array_head()} * 8);
      break;
    case NbtType::string:
      string();
      break;
    default:
      take(kNbtWidths[index_of(type)], "nbt: a number ends early");
  }
}

void NbtReader::skip(NbtType type) {
  std::array<OpenValue, kNbtDepthMax> open;  // not initialised: nearly every value is flat
  std::size_t depth = 0;
  while (!failed_) {
    if (type != NbtType::compound && type != NbtType::list) {
      skip_flat(type);
    } else if (depth == kNbtDepthMax) {
      reject(ErrorCode::limit_exceeded, "nbt: values are nested deeper than 512");
    } else if (type == NbtType::compound) {
      open[depth++] = {type, false, 0};
    } else {
      const NbtList head = list();
      const std::size_t width = kNbtWidths[index_of(head.type)];
      if (width != 0)
        skip_bytes(std::uint64_t{head.count} * width);
      else
        open[depth++] = {head.type, true, head.count};
    }
    // Finds the next value, and leaves what ended.
    NbtEntry entry;
    for (;;) {
      if (depth == 0) return;
      OpenValue& top = open[depth - 1];
      if (top.is_list && top.left > 0) {
        --top.left;
        type = top.type;
        break;
      }
      if (!top.is_list && next(entry)) {
        type = entry.type;
        break;
      }
      --depth;
    }
  }
}

std::string from_modified_utf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i, 2) == "\xc0\x80") {
      out.push_back('\0');
      i += 2;
    } else if (is_surrogate(text, i, 0xa0) && is_surrogate(text, i + 3, 0xb0)) {
      const unsigned upper = (low_bits(text[i + 1]) & 15u) << 6 | low_bits(text[i + 2]);
      const unsigned lower = (low_bits(text[i + 4]) & 15u) << 6 | low_bits(text[i + 5]);
      const unsigned c = 0x10000u + (upper << 10 | lower);
      out.push_back(static_cast<char>(0xf0u | c >> 18));
      out.push_back(static_cast<char>(0x80u | (c >> 12 & 63u)));
      out.push_back(static_cast<char>(0x80u | (c >> 6 & 63u)));
      out.push_back(static_cast<char>(0x80u | (c & 63u)));
      i += 6;
    } else {
      out.push_back(text[i++]);
    }
  }
  return out;
}

std::string to_modified_utf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const bool is_long = (static_cast<unsigned char>(text[i]) & 0xf8u) == 0xf0u &&
                         text.size() - i >= 4 && is_continuation(text[i + 1]) &&
                         is_continuation(text[i + 2]) && is_continuation(text[i + 3]);
    const unsigned c = !is_long ? 0
                                : (static_cast<unsigned char>(text[i]) & 7u) << 18 |
                                      low_bits(text[i + 1]) << 12 | low_bits(text[i + 2]) << 6 |
                                      low_bits(text[i + 3]);
    if (c >= 0x10000u && c <= 0x10ffffu) {
      put_surrogate(out, 0xd800u + ((c - 0x10000u) >> 10));
      put_surrogate(out, 0xdc00u + ((c - 0x10000u) & 0x3ffu));
      i += 4;
    } else if (text[i] == '\0') {
      out += "\xc0\x80";
      ++i;
    } else {
      out.push_back(text[i++]);
    }
  }
  return out;
}

}  // namespace runstone
