#include "server/textures/texture_import.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "common/os/private_file.hpp"
#include "common/textures/texture_hash.hpp"
#include "server/textures/luanti_pictures.hpp"
#include "server/textures/minecraft_pictures.hpp"
#include "server/textures/named_pictures.hpp"
#include "server/textures/picture_files.hpp"
#include "server/textures/texture_png.hpp"

namespace runstone {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPictureFileBytesMax = std::size_t{16} << 20;

using Source = std::unique_ptr<PictureSource>;

Result<Source, std::string> open_source(const std::string& place) {
  std::error_code error;
  if (fs::is_regular_file(place, error)) {
    return Source(std::make_unique<NamedPictures>(
        std::map<std::string, std::string>{{stem_of(place), place}}));
  }
  if (!fs::is_directory(place, error)) return failure(place + ": there is no such file or folder");
  const fs::path folder(place);
  if (fs::is_directory(folder / "assets", error)) return MinecraftPictures::open(place);
  for (const char* sign : {"game.conf", "modpack.conf", "mod.conf", "init.lua", "mods"}) {
    if (fs::exists(folder / sign, error)) return LuantiPictures::open(place);
  }
  auto found = files_below(place, ".png");
  if (!found) return failure(found.error());
  std::map<std::string, std::string> files;
  for (const auto& [name, path] : *found) files.emplace(stem_of(name), path);
  return Source(std::make_unique<NamedPictures>(std::move(files)));
}

/// A picture that materials want, and the sides of each material that show it.
struct WantedPicture {
  SidePicture picture;
  std::array<std::uint8_t, 3> tint{};
  std::map<Material, std::uint8_t> sides;
};

/// Finds what each material wants, in the order of the materials.
class Wanted {
 public:
  void add(Material id, const MaterialInfo& info, Direction side, const SidePicture& picture) {
    std::array<std::uint8_t, 3> tint{};
    if (picture.is_tinted) std::copy_n(info.colour.begin(), tint.size(), tint.begin());
    const auto [at, is_new] = index_of_.try_emplace({picture, tint}, pictures_.size());
    if (is_new) pictures_.push_back({picture, tint, {}});
    pictures_[at->second].sides[id] |= texture_side(side);
  }
  const std::vector<WantedPicture>& pictures() const { return pictures_; }

 private:
  std::map<std::pair<SidePicture, std::array<std::uint8_t, 3>>, std::size_t> index_of_;
  std::vector<WantedPicture> pictures_;
};

Result<Bytes, std::string> png_of_wanted(const WantedPicture& wanted) {
  std::vector<Bytes> layers;
  for (const std::string& path : wanted.picture.layers) {
    auto file = read_file_bytes(path, kPictureFileBytesMax);
    if (!file) return failure(file.error());
    layers.push_back(*std::move(file));
  }
  const auto tint = wanted.picture.is_tinted ? std::optional(wanted.tint) : std::nullopt;
  auto png = texture_png(layers, tint);
  if (!png) return failure(wanted.picture.layers[0] + ": " + png.error());
  return png;
}

/// Collects textures as long as the table of the world takes them.
class Taken {
 public:
  Taken(const TextureTable& present, TextureImport& out) : table_(present), out_(out) {}

  void add(const WantedPicture& wanted) {
    auto png = png_of_wanted(wanted);
    if (!png) return fault(png.error());
    const TextureHash hash = texture_hash(*png);
    GivenTexture given{*std::move(png), {}, hash};
    for (const auto& [material, sides] : wanted.sides) {
      given.uses.push_back({material, sides});
      if (given.uses.size() == kTextureUsesMax) take(given);
      if (is_full_) return;
    }
    if (!given.uses.empty()) take(given);
  }
  /// Returns true if the table has refused a picture because it has too many, or too many bytes.
  bool is_full() const { return is_full_; }
  std::size_t pictures() const { return table_.entries().size(); }
  std::size_t materials() const { return materials_.size(); }

 private:
  void take(GivenTexture& given) {
    if (const auto added = table_.add(texture_entry(given.png, given.uses, given.hash)); !added) {
      is_full_ = added.error().code == ErrorCode::limit_exceeded;
      fault(added.error().what);
    } else {
      for (const TextureUse& use : given.uses) {
        materials_.insert(use.material);
        for (unsigned bits = use.sides; bits != 0; bits &= bits - 1) ++out_.sides;
      }
      out_.textures.push_back(std::make_shared<const GivenTexture>(given));
    }
    given.uses.clear();
  }
  void fault(std::string line) {
    if (out_.faults++ < kTextureLinesShown) out_.fault_lines.push_back(std::move(line));
  }

  TextureTable table_;
  std::set<Material> materials_;  // that get a picture
  bool is_full_ = false;
  TextureImport& out_;
};

std::string counted_as(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

Result<TextureImport, std::string> import_textures(const std::string& place,
                                                   const MaterialTable& materials,
                                                   const TextureTable& present,
                                                   const std::function<bool()>& should_continue) {
  auto source = open_source(place);
  if (!source) return failure(source.error());
  TextureImport out;
  out.kind = (*source)->kind();
  Wanted wanted;
  for (std::size_t i = 1; i < materials.size(); ++i) {
    if (should_continue && !should_continue()) return failure(place + ": was cancelled");
    const auto id = static_cast<Material>(i);
    const MaterialInfo& info = materials[id];
    if (info.visibility == Visibility::empty) continue;
    const SidePictures pictures = (*source)->pictures_of(info);
    if (pictures.empty()) {
      if (out.without++ < kTextureLinesShown) out.without_names.push_back(info.name);
      continue;
    }
    for (std::size_t side = 0; side < kDirectionCount; ++side) {
      const auto direction = static_cast<Direction>(side);
      if (pictures[direction].layers.empty()) continue;
      if (present.number(id, direction) != 0) {
        ++out.sides_before;
        continue;
      }
      wanted.add(id, info, direction, pictures[direction]);
    }
  }
  Taken taken(present, out);
  const std::vector<WantedPicture>& pictures = wanted.pictures();
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (should_continue && !should_continue()) return failure(place + ": was cancelled");
    taken.add(pictures[i]);
    if (!taken.is_full()) continue;
    out.faults += pictures.size() - i - 1;
    break;
  }
  out.materials = taken.materials();
  out.pictures = taken.pictures() - present.entries().size();
  return out;
}

std::string textures_text(const TextureImport& found) {
  const auto shown = [](const std::vector<std::string>& lines, std::size_t count,
                        const char* between) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : between) + line;
    if (count > lines.size()) text += between + std::to_string(count - lines.size()) + " more";
    return text;
  };
  std::string text = found.kind + ": " + counted_as(found.pictures, "picture") + " for " +
                     counted_as(found.materials, "material") + " (" +
                     counted_as(found.sides, "side") + ")";
  if (found.sides_before > 0)
    text +=
        "\n" + counted_as(found.sides_before, "side") + " with a picture already stay as they are";
  if (found.without > 0)
    text += "\nno picture there for " + counted_as(found.without, "material") + ": " +
            shown(found.without_names, found.without, ", ");
  if (found.faults > 0)
    text += "\nnot used: " + shown(found.fault_lines, found.faults, "\nnot used: ");
  return text;
}

}  // namespace runstone
