#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/grid_pieces.hpp"
#include "common/formats/npy.hpp"
#include "common/formats/npy_header.hpp"
#include "common/formats/zip_members.hpp"

namespace runstone {
namespace {

constexpr std::size_t kNpyBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kNpyTextBytesMax = std::size_t{32} << 20;
constexpr std::uint64_t kNpyNumbersMax = 65'536;
/// A number that no cell may have.
constexpr std::uint64_t kNpyBadNumber = UINT64_MAX;

/// The meaning of the cell numbers.
struct NpyBlocks {
  std::optional<std::vector<std::string>> names, states;
  std::optional<std::vector<std::uint8_t>> colours;  // 4 each
  std::uint64_t numbers = kNpyNumbersMax;            // greater ones have no name

  /// Returns nullopt for an untouched cell.
  std::optional<ForeignBlock> block(std::uint64_t number) const {
    ForeignBlock out;
    if (names) {
      out.name = (*names)[static_cast<std::size_t>(number)];
      if (out.name.empty()) return std::nullopt;
    } else {
      out.name = number == 0 ? "air" : "material " + std::to_string(number);
    }
    if (states) out.states = (*states)[static_cast<std::size_t>(number)];
    if (colours && out.name != "air") {
      ForeignLook look;
      std::copy_n(colours->begin() + static_cast<std::ptrdiff_t>(number * 4), 4,
                  look.colour.begin());
      out.look = look;
    }
    return out;
  }
};

/// Reads the items of an array. `bytes_max` is what the source holds at most, so that no memory is
/// taken for items that it cannot have.
class NpyItems {
 public:
  NpyItems(InflateSource& source, const NpyHeader& header, std::uint64_t bytes_max,
           std::size_t offset)
      : source_(source), header_(header), bytes_max_(bytes_max), offset_(offset) {}

  /// Fails if the source cannot hold so many items.
  Result<void> check(std::uint64_t count) const {
    if (header_.item_bytes > 0 && count > bytes_max_ / header_.item_bytes) return cut();
    return {};
  }

  Unexpected<Error> cut() const {
    if (source_.is_damaged()) return at(ErrorCode::bad_value, "npy: a deflate stream is damaged");
    return at(ErrorCode::truncated, "npy: array has fewer items than its shape");
  }
  Unexpected<Error> at(ErrorCode code, const char* what) const {
    return fail(code, what, offset_ + source_.offset());
  }
  /// Fails if bytes follow the last item.
  Result<void> finish() {
    std::array<std::uint8_t, 1> more{};
    if (source_.read(more)) return at(ErrorCode::trailing_bytes, "npy: bytes follow the last item");
    return {};
  }

  /// Calls f with spans of numbers. A number that is negative is kNpyBadNumber.
  template <class F>
  Result<void> numbers(std::uint64_t count, F&& f) {
    if (auto checked = check(count); !checked) return checked;
    switch (header_.item_bytes) {
      case 1:
        return numbers_of<std::uint8_t>(count, f);
      case 2:
        return numbers_of<std::uint16_t>(count, f);
      case 4:
        return numbers_of<std::uint32_t>(count, f);
      default:
        return numbers_of<std::uint64_t>(count, f);
    }
  }
  Result<std::vector<std::string>> texts(std::uint64_t count);

 private:
  template <class T, class F>
  Result<void> numbers_of(std::uint64_t count, F& f) {
    const auto room =
        static_cast<std::size_t>(std::min<std::uint64_t>(count, kNpyBufferBytes / sizeof(T)));
    std::vector<std::uint8_t> bytes(room * sizeof(T));
    std::vector<std::uint64_t> out(room);
    const bool is_signed = header_.kind == 'i';
    while (count > 0) {
      const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(count, out.size()));
      if (!source_.read(std::span(bytes).first(part * sizeof(T)))) return cut();
      for (std::size_t i = 0; i < part; ++i) {
        T item;
        std::memcpy(&item, &bytes[i * sizeof(T)], sizeof(T));
        if (header_.is_big_endian) {
          T turned = 0;
          for (unsigned byte = 0; byte < sizeof(T); ++byte)
            turned = static_cast<T>(turned | static_cast<T>(static_cast<T>(item >> (8 * byte) & 255)
                                                            << (8 * (sizeof(T) - 1 - byte))));
          item = turned;
        }
        const bool is_negative = is_signed && (item >> (8 * sizeof(T) - 1) & 1) != 0;
        out[i] = is_negative ? kNpyBadNumber : item;
      }
      if (auto taken = f(std::span<const std::uint64_t>(out).first(part)); !taken) return taken;
      count -= part;
    }
    return {};
  }

  InflateSource& source_;
  const NpyHeader& header_;
  std::uint64_t bytes_max_;
  std::size_t offset_;  // of the packed source in the file
};

void append_utf8(std::string& out, std::uint32_t c) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xc0 | c >> 6);
    put(0x80 | (c & 63));
  } else if (c < 0x10000) {
    put(0xe0 | c >> 12);
    put(0x80 | (c >> 6 & 63));
    put(0x80 | (c & 63));
  } else {
    put(0xf0 | c >> 18);
    put(0x80 | (c >> 12 & 63));
    put(0x80 | (c >> 6 & 63));
    put(0x80 | (c & 63));
  }
}

Result<std::vector<std::string>> NpyItems::texts(std::uint64_t count) {
  if (auto checked = check(count); !checked) return failure(checked.error());
  std::vector<std::string> out;
  std::vector<std::uint8_t> item(header_.item_bytes);
  std::size_t bytes = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!source_.read(item)) return cut();
    std::string text;
    if (header_.kind == 'S') {
      text.assign(item.begin(), item.end());
      text.erase(text.find_last_not_of('\0') + 1);
    } else {
      for (std::size_t at = 0; at < item.size(); at += 4) {
        const auto byte = [&](std::size_t k) {
          return std::uint32_t{item[at + (header_.is_big_endian ? 3 - k : k)]};
        };
        const std::uint32_t c = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
        if (c > 0x10ffff || (c >= 0xd800 && c < 0xe000))
          return this->at(ErrorCode::bad_value, "npy: a string has a bad character");
        append_utf8(text, c);
      }
      text.erase(text.find_last_not_of('\0') + 1);
    }
    bytes += text.size() + sizeof(std::string);
    if (bytes > kNpyTextBytesMax)
      return this->at(ErrorCode::limit_exceeded, "npy: strings take more than 32 MiB");
    out.push_back(std::move(text));
  }
  return out;
}

Result<void> read_npy_cells(const NpyHeader& header, NpyItems& items, const NpyBlocks& known,
                            const PieceSink& sink) {
  if (header.shape.size() != 3)
    return items.at(ErrorCode::bad_value, "npy: array of voxels has not three axes");
  if (!header.is_integer()) return items.at(ErrorCode::bad_value, "npy: voxels are not integers");
  for (const std::uint64_t side : header.shape) {
    if (side < 1 || side > kBuildSideMax)
      return items.at(ErrorCode::limit_exceeded,
                      "npy: a side of the array is outside 1 .. 1048576");
  }
  const std::uint64_t count = header.items();
  if (auto checked = items.check(count); !checked) return checked;
  std::vector<ForeignBlock> blocks;
  // By number: the index of its block + 1, and 0 for untouched cells.
  std::vector<Material> materials(static_cast<std::size_t>(known.numbers), 0);
  std::vector<bool> is_known(materials.size(), false);
  const auto side = [&](std::size_t axis) { return static_cast<std::int32_t>(header.shape[axis]); };
  const VoxelPos sides{side(0), side(1), side(2)};
  const AxisOrder order = header.is_fortran ? AxisOrder::xyz : AxisOrder::zyx;
  if (!GridPieces::are_sides(sides, order))
    return items.at(ErrorCode::limit_exceeded, "npy: a layer has more than 268435456 cells");
  GridPieces pieces({{0, 0, 0}, sides}, order, blocks, sink);
  std::uint64_t open_number = 0;  // of the cells that are not appended yet
  std::uint64_t open_count = 0;
  const auto flush = [&]() -> Result<void> {
    if (open_count == 0) return {};
    if (open_number >= known.numbers)
      return items.at(ErrorCode::bad_value, known.names ? "npy: a voxel has a number without a name"
                                                        : "npy: a voxel is outside 0 .. 65535");
    const auto number = static_cast<std::size_t>(open_number);
    if (!is_known[number]) {
      is_known[number] = true;
      if (auto block = known.block(open_number)) {
        if (blocks.size() == kMaterialCountMax - 1)
          return items.at(ErrorCode::limit_exceeded, "npy: more than 65535 different voxels");
        blocks.push_back(*std::move(block));
        materials[number] = static_cast<Material>(blocks.size());
      }
    }
    const std::uint64_t cells = std::exchange(open_count, 0);
    return pieces.append(cells, materials[number]);
  };
  auto read = items.numbers(count, [&](std::span<const std::uint64_t> numbers) -> Result<void> {
    for (const std::uint64_t number : numbers) {
      if (number != open_number) {
        if (auto flushed = flush(); !flushed) return flushed;
        open_number = number;
      }
      ++open_count;
    }
    return {};
  });
  if (!read) return read;
  if (auto finished = items.finish(); !finished) return finished;
  return flush();
}

/// An array of an .npz, opened.
struct NpzArray {
  const ZipMember* member;
  InflateSource source;
  NpyHeader header;

  NpyItems items() { return {source, header, member->bytes, member->offset}; }
};

class NpzReader {
 public:
  NpzReader(std::vector<ZipMember> members) : members_(std::move(members)) {}

  Result<ForeignInfo> read(const PieceSink& sink) {
    NpyBlocks blocks;
    if (auto done = read_texts("names.npy", blocks.names, blocks); !done)
      return failure(done.error());
    if (auto done = read_texts("states.npy", blocks.states, blocks); !done)
      return failure(done.error());
    if (auto done = read_colours(blocks); !done) return failure(done.error());
    ForeignInfo info;
    if (auto done = read_origin(info); !done) return failure(done.error());
    auto array = open("voxels.npy");
    if (!array) return failure(array.error());
    if (!*array) return fail(ErrorCode::bad_value, "npz: array `voxels` is missing", 0);
    NpzArray& voxels = **array;
    NpyItems items = voxels.items();
    auto done = read_npy_cells(voxels.header, items, blocks, sink);
    if (done) done = check(voxels);
    if (!done) return failure(done.error());
    return info;
  }

 private:
  /// Returns a null pointer if there is no such member.
  Result<std::optional<NpzArray>> open(std::string_view name) {
    const auto found = std::find_if(members_.begin(), members_.end(),
                                    [&](const ZipMember& member) { return member.name == name; });
    if (found == members_.end()) return std::optional<NpzArray>{};
    InflateSource source = found->open();
    auto header = read_npy_header(source, found->bytes);
    if (!header)
      return fail(header.error().code, header.error().what, header.error().offset + found->offset);
    return std::optional<NpzArray>(NpzArray{&*found, std::move(source), *std::move(header)});
  }

  static Result<void> check(const NpzArray& array) {
    if (array.source.checksum() == array.member->checksum) return {};
    return fail(ErrorCode::bad_checksum, "npz: checksum of an array is wrong",
                array.member->offset);
  }

  /// Checks that an array has as many items as those before it.
  static Result<void> agree(NpyBlocks& blocks, const NpyItems& items, std::uint64_t count,
                            bool is_shape) {
    if (!is_shape || count > kNpyNumbersMax || count == 0)
      return items.at(ErrorCode::bad_value, "npz: names, states or colours have another shape");
    const bool is_first = !blocks.names && !blocks.states && !blocks.colours;
    if (!is_first && blocks.numbers != count)
      return items.at(ErrorCode::bad_value, "npz: names, states and colours differ in number");
    blocks.numbers = count;
    return {};
  }

  Result<void> read_texts(std::string_view name, std::optional<std::vector<std::string>>& out,
                          NpyBlocks& blocks) {
    auto array = open(name);
    if (!array) return failure(array.error());
    if (!*array) return {};
    NpyItems items = (*array)->items();
    const NpyHeader& header = (*array)->header;
    if (header.kind != 'S' && header.kind != 'U')
      return items.at(ErrorCode::bad_value, "npz: names and states must be strings");
    if (auto agreed = agree(blocks, items, header.items(), header.shape.size() == 1); !agreed)
      return agreed;
    auto texts = items.texts(header.items());
    if (!texts) return failure(texts.error());
    out = *std::move(texts);
    if (auto finished = items.finish(); !finished) return finished;
    return check(**array);
  }

  Result<void> read_colours(NpyBlocks& blocks) {
    auto array = open("colours.npy");
    if (array && !*array) array = open("colors.npy");
    if (!array) return failure(array.error());
    if (!*array) return {};
    NpyItems items = (*array)->items();
    const NpyHeader& header = (*array)->header;
    if (header.kind != 'u' || header.item_bytes != 1)
      return items.at(ErrorCode::bad_value, "npz: colours must be of u8");
    const bool is_shape = header.shape.size() == 2 && header.shape[1] == 4;
    if (auto agreed = agree(blocks, items, is_shape ? header.shape[0] : 0, is_shape); !agreed)
      return agreed;
    std::vector<std::uint8_t> parts;
    auto read = items.numbers(header.items(), [&](std::span<const std::uint64_t> numbers) {
      for (const std::uint64_t number : numbers) parts.push_back(static_cast<std::uint8_t>(number));
      return Result<void>{};
    });
    if (!read) return read;
    blocks.colours.emplace(parts.size());
    const std::size_t count = parts.size() / 4;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t from = header.is_fortran ? i % 4 * count + i / 4 : i;
      (*blocks.colours)[i] = parts[from];
    }
    if (auto finished = items.finish(); !finished) return finished;
    return check(**array);
  }

  Result<void> read_origin(ForeignInfo& info) {
    auto array = open("origin.npy");
    if (!array) return failure(array.error());
    if (!*array) return {};
    const NpyHeader& header = (*array)->header;
    NpyItems items = (*array)->items();
    if (!header.is_integer() || header.items() != 3)
      return items.at(ErrorCode::bad_value, "npz: origin is not of three integers");
    std::array<std::uint8_t, 24> bytes{};
    if (!(*array)->source.read(std::span(bytes).first(3 * header.item_bytes))) return items.cut();
    std::array<std::int32_t, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint64_t value = 0;
      for (std::size_t k = 0; k < header.item_bytes; ++k) {
        const std::size_t byte = header.is_big_endian ? k : header.item_bytes - 1 - k;
        value = value << 8 | bytes[i * header.item_bytes + byte];
      }
      const unsigned unused = 64 - 8 * header.item_bytes;
      const auto wide = header.kind == 'i' ? static_cast<std::int64_t>(value << unused) >> unused
                                           : static_cast<std::int64_t>(value);
      if (wide < -kWorldLimit || wide >= kWorldLimit)
        return items.at(ErrorCode::bad_value, "npz: origin lies outside the world");
      at[i] = static_cast<std::int32_t>(wide);
    }
    info.origin = {at[0], at[1], at[2]};
    if (auto finished = items.finish(); !finished) return finished;
    return check(**array);
  }

  std::vector<ZipMember> members_;
};

}  // namespace

Result<ForeignInfo> read_npy(ByteView file, const PieceSink& sink) {
  InflateSource source(file, std::nullopt);
  const auto header = read_npy_header(source, file.size());
  if (!header) return failure(header.error());
  NpyItems items(source, *header, file.size() - source.offset(), 0);
  if (auto done = read_npy_cells(*header, items, {}, sink); !done) return failure(done.error());
  return ForeignInfo{};
}

Result<ForeignInfo> read_npz(ByteView file, const PieceSink& sink) {
  auto members = zip_members(file);
  if (!members) return failure(members.error());
  return NpzReader(*std::move(members)).read(sink);
}

}  // namespace runstone
