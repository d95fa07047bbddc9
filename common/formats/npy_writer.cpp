#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/grid_cells.hpp"
#include "common/formats/npy.hpp"
#include "common/formats/npy_header.hpp"

namespace runstone {
namespace {

constexpr std::size_t kNpyWriteBytes = std::size_t{1} << 16;
constexpr int kNpzLevel = 6;

/// The numbers of the cells in an array.
struct NpyNumbers {
  std::vector<std::uint16_t> of_cell;  // by cell number of the build
  std::uint16_t greatest = 0;
  std::uint64_t item_bytes() const { return greatest < 256 ? 1 : 2; }
  std::string type() const { return greatest < 256 ? "|u1" : "<u2"; }
};

bool is_air(const BuildMaterial& material) { return material.row.visibility == Visibility::empty; }

bool has_untouched(const FileBuild& build) {
  return build.build->touched() != build.build->volume();
}

/// Returns the n of a material "material n", or nullopt if it has another name.
std::optional<std::uint16_t> number_of_name(const BuildMaterial& material) {
  constexpr std::string_view kPrefix = "material ";
  std::string_view name = material.row.name;
  if (!material.states.empty() || !name.starts_with(kPrefix)) return std::nullopt;
  name.remove_prefix(kPrefix.size());
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size() || number == 0 ||
      name.front() == '0')
    return std::nullopt;
  return number;
}

/// Gives the cells of a build as an array in C order: z fastest, x slowest.
Result<void> give_cells(const Build& build, const NpyNumbers& numbers, const FormatSink& sink) {
  const bool is_wide = numbers.item_bytes() == 2;
  Bytes buffer;
  ByteWriter w(buffer);
  const auto walked =
      walk_cells(build, AxisOrder::zyx, [&](std::uint32_t count, std::uint16_t cell) {
        const std::uint16_t number = numbers.of_cell[cell];
        if (is_wide) {
          for (std::uint32_t i = 0; i < count; ++i) w.u16(number);
        } else {
          buffer.insert(buffer.end(), count, static_cast<std::uint8_t>(number));
        }
        if (buffer.size() < kNpyWriteBytes) return Result<void>{};
        if (!sink(buffer))
          return Result<void>(fail(ErrorCode::io_failed, "npy: cannot be written"));
        buffer.clear();
        return Result<void>{};
      });
  if (!walked) return walked;
  if (!sink(buffer)) return fail(ErrorCode::io_failed, "npy: cannot be written");
  return {};
}

Bytes voxel_header(const Build& build, const NpyNumbers& numbers) {
  const VoxelPos sides = build.sides();
  const std::array<std::uint64_t, 3> shape = {static_cast<std::uint64_t>(sides.x),
                                              static_cast<std::uint64_t>(sides.y),
                                              static_cast<std::uint64_t>(sides.z)};
  return npy_header(numbers.type(), shape);
}

NpyNumbers numbers_of_npy(const FileBuild& build) {
  NpyNumbers out;
  out.of_cell.push_back(0);
  bool are_numbered = true;
  for (const BuildMaterial& material : build.materials)
    are_numbered = are_numbered && (is_air(material) || number_of_name(material));
  std::uint16_t next = 0;
  for (const BuildMaterial& material : build.materials) {
    const std::uint16_t number = is_air(material) ? std::uint16_t{0}
                                 : are_numbered   ? *number_of_name(material)
                                                  : ++next;
    out.of_cell.push_back(number);
    out.greatest = std::max(out.greatest, number);
  }
  return out;
}

/// The numbers of an .npz, and what they are.
struct NpzNumbers {
  NpyNumbers numbers;
  std::vector<const BuildMaterial*> materials;  // by number; null: untouched
};

NpzNumbers numbers_of_npz(const FileBuild& build) {
  NpzNumbers out;
  std::vector<std::uint16_t>& of_cell = out.numbers.of_cell;
  of_cell.assign(build.materials.size() + 1, 0);
  const auto air = std::find_if(build.materials.begin(), build.materials.end(), is_air);
  const bool has_air = air != build.materials.end();
  out.materials.push_back(has_air ? &*air : nullptr);
  const auto next = [&] { return static_cast<std::uint16_t>(out.materials.size()); };
  for (std::size_t i = 0; i < build.materials.size(); ++i) {
    if (is_air(build.materials[i])) continue;
    of_cell[i + 1] = next();
    out.materials.push_back(&build.materials[i]);
  }
  if (has_air && has_untouched(build)) {
    of_cell[0] = next();
    out.materials.push_back(nullptr);
  }
  out.numbers.greatest = static_cast<std::uint16_t>(out.materials.size() - 1);
  return out;
}

/// Returns the characters of well-formed UTF-8.
std::vector<std::uint32_t> characters_of(std::string_view text) {
  std::vector<std::uint32_t> out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0U) == 0x80U && !out.empty()) {
      out.back() = out.back() << 6 | (byte & 0x3fU);
    } else {
      out.push_back(byte < 0x80   ? byte
                    : byte < 0xe0 ? byte & 0x1fU
                    : byte < 0xf0 ? byte & 0x0fU
                                  : byte & 0x07U);
    }
  }
  return out;
}

/// Returns an array of strings, with its head.
Bytes text_array(const std::vector<std::string_view>& texts) {
  std::vector<std::vector<std::uint32_t>> rows;
  std::size_t length = 1;
  for (const std::string_view text : texts) {
    rows.push_back(characters_of(text));
    length = std::max(length, rows.back().size());
  }
  const std::array<std::uint64_t, 1> shape = {texts.size()};
  Bytes out = npy_header("<U" + std::to_string(length), shape);
  ByteWriter w(out);
  for (auto& row : rows) {
    row.resize(length);
    for (const std::uint32_t c : row) w.u32(c);
  }
  return out;
}

/// Writes a zip file whose members are deflated, without times.
class ZipWriter {
 public:
  explicit ZipWriter(const FormatSink& sink) : sink_(sink) {}

  /// Gives a member, of which `fill` gives the bytes to its sink.
  Result<void> add(const std::string& name,
                   const std::function<Result<void>(const FormatSink&)>& fill);
  Result<void> finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t checksum = 0, packed_bytes = 0, bytes = 0, offset = 0;
  };
  static constexpr std::uint16_t kFlags = 8;  // sizes follow the member
  static constexpr std::uint16_t kMethod = 8, kVersion = 20;
  static constexpr std::uint32_t kTime = 33U << 16;  // the first day of 1980

  bool give(ByteView bytes) {
    offset_ += bytes.size();
    return sink_(bytes);
  }

  const FormatSink& sink_;
  std::vector<Entry> entries_;
  std::uint64_t offset_ = 0;
};

Result<void> ZipWriter::add(const std::string& name,
                            const std::function<Result<void>(const FormatSink&)>& fill) {
  const auto broken = [] { return fail(ErrorCode::io_failed, "npz: cannot be written"); };
  Entry entry{name};
  entry.offset = static_cast<std::uint32_t>(offset_);
  Bytes head;
  ByteWriter w(head);
  w.u32(0x04034b50);
  w.u16(kVersion);
  w.u16(kFlags);
  w.u16(kMethod);
  w.u32(kTime);
  for (int i = 0; i < 3; ++i) w.u32(0);
  w.u16(static_cast<std::uint16_t>(name.size()));
  w.u16(0);
  w.bytes({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()});
  if (!give(head)) return broken();

  Bytes packed;
  Deflater deflater(DeflateForm::raw, kNpzLevel, packed);
  std::uint64_t bytes = 0, packed_bytes = 0;
  uLong checksum = 0;
  const auto give_packed = [&] {
    packed_bytes += packed.size();
    const bool is_taken = packed.empty() || give(packed);
    packed.clear();
    return is_taken;
  };
  const auto filled = fill([&](ByteView part) {
    // A part has a buffer of voxels or a whole other array, far below 4 GiB.
    bytes += part.size();
    checksum = crc32_z(checksum, part.data(), part.size());
    deflater.write(part);
    return give_packed();
  });
  if (!filled) return filled;
  deflater.finish();
  if (!give_packed()) return broken();
  entry.checksum = static_cast<std::uint32_t>(checksum);
  entry.bytes = static_cast<std::uint32_t>(bytes);
  entry.packed_bytes = static_cast<std::uint32_t>(packed_bytes);
  Bytes tail;
  ByteWriter t(tail);
  for (const std::uint32_t field : {0x08074b50U, entry.checksum, entry.packed_bytes, entry.bytes})
    t.u32(field);
  if (!give(tail)) return broken();
  entries_.push_back(std::move(entry));
  return {};
}

Result<void> ZipWriter::finish() {
  const std::uint64_t begin = offset_;
  Bytes out;
  ByteWriter w(out);
  for (const Entry& entry : entries_) {
    w.u32(0x02014b50);
    w.u16(kVersion);
    w.u16(kVersion);
    w.u16(kFlags);
    w.u16(kMethod);
    w.u32(kTime);
    w.u32(entry.checksum);
    w.u32(entry.packed_bytes);
    w.u32(entry.bytes);
    w.u16(static_cast<std::uint16_t>(entry.name.size()));
    for (int i = 0; i < 4; ++i) w.u16(0);  // extra, comment, disk, attributes
    w.u32(0);
    w.u32(entry.offset);
    w.bytes({reinterpret_cast<const std::uint8_t*>(entry.name.data()), entry.name.size()});
  }
  const std::size_t bytes = out.size();
  w.u32(0x06054b50);
  w.u32(0);  // disks
  w.u16(static_cast<std::uint16_t>(entries_.size()));
  w.u16(static_cast<std::uint16_t>(entries_.size()));
  w.u32(static_cast<std::uint32_t>(bytes));
  w.u32(static_cast<std::uint32_t>(begin));
  w.u16(0);
  if (!give(out)) return fail(ErrorCode::io_failed, "npz: cannot be written");
  return {};
}

}  // namespace

Result<void> write_npy(const FileBuild& build, const FormatSink& sink) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  const NpyNumbers numbers = numbers_of_npy(build);
  if (build.build->volume() > kNpyBytesMax / numbers.item_bytes())
    return fail(ErrorCode::limit_exceeded, "npy: array has more than 64 GiB");
  if (!sink(voxel_header(*build.build, numbers)))
    return fail(ErrorCode::io_failed, "npy: cannot be written");
  return give_cells(*build.build, numbers, sink);
}

Result<void> write_npz(const FileBuild& build, const FormatSink& sink) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  const NpzNumbers of = numbers_of_npz(build);
  if (build.build->volume() > kNpzBytesMax / of.numbers.item_bytes())
    return fail(ErrorCode::limit_exceeded, "npz: voxels have more than 3840 MiB");
  std::vector<std::string_view> names, states;
  bool has_states = false;
  const std::array<std::uint64_t, 2> colour_shape = {of.materials.size(), 4};
  Bytes colours = npy_header("|u1", colour_shape);
  for (const BuildMaterial* material : of.materials) {
    const bool is_named = material != nullptr;
    names.push_back(!is_named           ? std::string_view()
                    : is_air(*material) ? std::string_view("air")
                                        : std::string_view(material->row.name));
    states.push_back(is_named ? std::string_view(material->states) : std::string_view());
    has_states = has_states || !states.back().empty();
    const MaterialColour colour = is_named ? material->row.colour : MaterialColour{0, 0, 0, 0};
    colours.insert(colours.end(), colour.begin(), colour.end());
  }
  const std::array<std::uint64_t, 1> origin_shape = {3};
  Bytes origin = npy_header("<i4", origin_shape);
  ByteWriter w(origin);
  for (const std::int32_t at : {build.info.origin.x, build.info.origin.y, build.info.origin.z})
    w.u32(static_cast<std::uint32_t>(at));

  ZipWriter zip(sink);
  const auto add = [&](const std::string& name, const Bytes& bytes) {
    return zip.add(name, [&](const FormatSink& out) -> Result<void> {
      if (!out(bytes)) return fail(ErrorCode::io_failed, "npz: cannot be written");
      return {};
    });
  };
  if (auto done = zip.add("voxels.npy",
                          [&](const FormatSink& out) -> Result<void> {
                            if (!out(voxel_header(*build.build, of.numbers)))
                              return fail(ErrorCode::io_failed, "npz: cannot be written");
                            return give_cells(*build.build, of.numbers, out);
                          });
      !done)
    return done;
  if (auto done = add("names.npy", text_array(names)); !done) return done;
  if (has_states) {
    if (auto done = add("states.npy", text_array(states)); !done) return done;
  }
  if (auto done = add("colours.npy", colours); !done) return done;
  if (auto done = add("origin.npy", origin); !done) return done;
  return zip.finish();
}

}  // namespace runstone
