#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/version.hpp"
#include "common/model_writers/model_walk.hpp"
#include "common/model_writers/model_writers.hpp"

namespace runstone {
namespace {

/// Returns a text without blanks and control characters: many readers end a name at a blank.
std::string obj_word(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (static_cast<unsigned char>(c) <= ' ' || c == 0x7f || c == '#') c = '_';
  }
  return out.empty() ? "_" : out;
}

/// Returns the names of the materials, all different, by palette entry.
std::vector<std::string> obj_names(const std::vector<WrittenMaterial>& materials) {
  std::vector<std::string> out;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::string name = obj_word(materials[i].name);
    while (!taken.insert(name).second) name += "_" + std::to_string(i + 1);
    out.push_back(std::move(name));
  }
  return out;
}

void write_obj_comment(const WrittenBuild& source, ModelOutput& out) {
  out.text("# Runstone ");
  out.text(version());
  out.text("\n");
  const VoxelPos& origin = source.info.origin;
  out.text("# origin in the world: ");
  out.number(origin.x);
  out.text(" ");
  out.number(origin.y);
  out.text(" ");
  out.number(origin.z);
  out.text("\n");
}

/// A place in sixteenths of a voxel.
using ObjPlace = std::array<std::int32_t, 3>;

class ObjWriter {
 public:
  ObjWriter(const WrittenBuild& source, const ModelWriting& writing, const ModelSink& sink)
      : source_(source), writing_(writing), walk_(source, writing, PlaneSides::both), out_(sink) {}

  Result<void> write() {
    names_ = obj_names(source_.materials);
    walk_.for_each_region([&](const RegionModel& region) {
      if (region_ == 0) write_head();
      write_region(region);
      return out_.ok();
    });
    if (const auto checked = walk_.check(); !checked) return checked;
    if (region_ == 0) return fail(ErrorCode::bad_value, "model: build shows no face");
    if (!out_.flush()) return fail(ErrorCode::io_failed, "model: cannot be written");
    return {};
  }

 private:
  void write_head() {
    write_obj_comment(source_, out_);
    const std::string& file = writing_.material_file;
    const bool is_one_line = std::none_of(
        file.begin(), file.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; });
    if (!file.empty() && is_one_line) {
      out_.text("mtllib ");
      out_.text(file);
      out_.text("\n");
    }
    out_.text("o ");
    out_.text(obj_word(source_.info.name));
    out_.text("\n");
    for (const std::size_t axis : {0U, 1U, 2U}) {
      for (const int sign : {-1, 1}) {
        ModelNormal normal{};
        normal[axis] = static_cast<std::int8_t>(sign);
        normal_number(normal);
      }
    }
  }

  /// Returns the number of a normal in the file, and writes it if it is new.
  std::size_t normal_number(const ModelNormal& normal) {
    const auto [known, is_new] = normals_.try_emplace(normal, normals_.size() + 1);
    if (is_new) {
      out_.text("vn");
      for (const double share : unit_normal(normal)) {
        out_.text(" ");
        out_.number(static_cast<float>(share));
      }
      out_.text("\n");
    }
    return known->second;
  }

  void write_region(const RegionModel& region) {
    ++region_;
    if (writing_.is_welded) in_region_.assign(kRegionPoints * kRegionPoints * kRegionPoints, 0);
    fine_in_region_.clear();
    region_first_ = vertex_count_;
    for (const ModelPart& part : region.parts) {
      if (part.number != number_) {
        out_.text("usemtl ");
        out_.text(names_[part.number - 1U]);
        out_.text("\n");
        number_ = part.number;
      }
      const auto vertices = region.vertices_of(part);
      of_part_.clear();
      for (const ModelVertex& vertex : vertices) of_part_.push_back(number_of(region, vertex));
      const auto indices = region.indices_of(part);
      for (std::size_t i = 0; i < indices.size(); i += 3) {
        const std::size_t normal = normal_number(vertices[indices[i]].normal);
        out_.text("f");
        for (std::size_t k = i; k < i + 3; ++k) {
          out_.text(" ");
          out_.number(of_part_[indices[k]]);
          out_.text("//");
          out_.number(normal);
        }
        out_.text("\n");
      }
    }
  }

  /// Returns the number of a vertex in the file, and writes it if it is new.
  std::uint64_t number_of(const RegionModel& region, const ModelVertex& vertex) {
    const VoxelPos& origin = region.origin;
    const ObjPlace at = {origin.x * kModelUnits + vertex.x, origin.y * kModelUnits + vertex.y,
                         origin.z * kModelUnits + vertex.z};
    if (!writing_.is_welded) return write_vertex(at);
    const bool is_between = std::any_of(
        at.begin(), at.end(), [](std::int32_t place) { return place % kModelRegionUnits == 0; });
    if (std::any_of(at.begin(), at.end(),
                    [](std::int32_t place) { return place % kModelUnits != 0; })) {
      std::uint64_t& number = (is_between ? fine_between_regions_ : fine_in_region_)[at];
      if (number == 0) number = write_vertex(at);
      return number;
    }
    if (is_between) {
      // 21 bits each: a side has at most 2^20 voxels.
      const std::uint64_t key = static_cast<std::uint64_t>(at[0] / kModelUnits) |
                                static_cast<std::uint64_t>(at[1] / kModelUnits) << 21 |
                                static_cast<std::uint64_t>(at[2] / kModelUnits) << 42;
      std::uint64_t& number = between_regions_[key];
      if (number == 0) number = write_vertex(at);
      return number;
    }
    const auto voxel = [](std::uint16_t place) { return std::size_t{place} / kModelUnits; };
    std::uint32_t& number =
        in_region_[voxel(vertex.x) +
                   kRegionPoints * (voxel(vertex.y) + kRegionPoints * voxel(vertex.z))];
    if (number == 0) number = static_cast<std::uint32_t>(write_vertex(at) - region_first_);
    return region_first_ + number;
  }

  std::uint64_t write_vertex(const ObjPlace& at) {
    out_.text("v");
    for (const std::int32_t place : at) {
      out_.text(" ");
      const double voxels = static_cast<double>(place) / kModelUnits;
      if (writing_.metres_per_voxel != 1) {
        out_.number(static_cast<float>(voxels * writing_.metres_per_voxel));
      } else if (place % kModelUnits == 0) {
        out_.number(place / kModelUnits);
      } else {
        out_.number(voxels);
      }
    }
    out_.text("\n");
    return ++vertex_count_;
  }

  const WrittenBuild& source_;
  const ModelWriting& writing_;
  ModelWalk walk_;
  ModelOutput out_;
  std::vector<std::string> names_;  // by palette entry
  std::size_t region_ = 0;          // regions written
  std::uint16_t number_ = 0;        // the material in use
  std::uint64_t vertex_count_ = 0;
  std::uint64_t region_first_ = 0;  // the vertices before the region
  /// The numbers of the vertices inside of the region, after region_first_; 0: none.
  std::vector<std::uint32_t> in_region_;
  std::unordered_map<std::uint64_t, std::uint64_t> between_regions_;
  /// The numbers of the vertices that lie between the corners of voxels.
  std::map<ObjPlace, std::uint64_t> fine_in_region_, fine_between_regions_;
  std::map<ModelNormal, std::size_t> normals_;
  std::vector<std::uint64_t> of_part_;
};

}  // namespace

Result<void> write_obj_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink) {
  RUNSTONE_ASSERT(std::isfinite(writing.metres_per_voxel) && writing.metres_per_voxel > 0);
  return ObjWriter(source, writing, sink).write();
}

Result<void> write_mtl_model(const WrittenBuild& source, const ModelSink& sink) {
  ModelOutput out(sink);
  write_obj_comment(source, out);
  const std::vector<std::string> names = obj_names(source.materials);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const WrittenMaterial& material = source.materials[i];
    if (material.visibility == Visibility::empty) continue;
    const auto colour = [&](std::string_view key, double share) {
      out.text(key);
      for (std::size_t k = 0; k < 3; ++k) {
        out.text(" ");
        out.rounded(material.colour[k] / 255.0 * share);
      }
      out.text("\n");
    };
    const auto value = [&](std::string_view key, double v) {
      out.text(key);
      out.text(" ");
      out.rounded(v);
      out.text("\n");
    };
    const double gloss = 1 - material.look.roughness / 100.0;
    out.text("\nnewmtl ");
    out.text(names[i]);
    out.text("\n");
    colour("Kd", 1);
    out.text("Ks 0 0 0\n");
    value("Ns", 1000 * gloss * gloss);
    value("Pr", material.look.roughness / 100.0);
    if (material.look.emission > 0) colour("Ke", material.look.emission / 100.0);
    value("d", material.colour[3] / 255.0);
    out.text("illum 1\n");
  }
  if (!out.flush()) return fail(ErrorCode::io_failed, "model: cannot be written");
  return {};
}

}  // namespace runstone
