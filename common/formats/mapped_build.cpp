#include "common/formats/mapped_build.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/formats/named_build.hpp"

namespace runstone {

Result<FileBuild> mapped_build(const FileBuild& build, const MaterialMap& map, AppliedRows& applied,
                               std::size_t bytes_max) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  using Key = std::pair<std::string, std::string>;  // name and states
  std::vector<BuildMaterial> materials;
  std::map<Key, std::size_t> kept;  // the materials that stay as they are
  std::vector<bool> is_mapped;
  for (const BuildMaterial& material : build.materials) {
    auto row = map.apply(material, applied);
    is_mapped.push_back(row.has_value());
    if (!row) kept.insert_or_assign(Key{material.row.name, material.states}, materials.size());
    materials.push_back(row ? BuildMaterial{*std::move(row), ""} : material);
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto same = kept.find(Key{materials[i].row.name, materials[i].states});
    if (is_mapped[i] && same != kept.end()) materials[i].row = materials[same->second].row;
  }
  return named_build(build.info, *build.build, std::move(materials), bytes_max);
}

}  // namespace runstone
