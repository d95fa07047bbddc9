// MappedParts: the parts of another ImportParts, with the materials that a MaterialMap chooses.
#pragma once
#include <memory>
#include <utility>

#include "common/formats/material_map.hpp"
#include "server/import/import_parts.hpp"

namespace runstone {

class MappedParts final : public ImportParts {
 public:
  /// `map` must outlive the object.
  MappedParts(std::unique_ptr<ImportParts> parts, const MaterialMap& map)
      : parts_(std::move(parts)), map_(map) {}

  std::size_t count() const override { return parts_->count(); }
  Result<std::optional<ImportPart>, std::string> read(std::size_t index,
                                                      ImportFaults& faults) override;
  std::optional<VoxelPos> spawn() const override { return parts_->spawn(); }
  std::vector<std::string> notices() const override { return parts_->notices(); }
  /// Returns the rows that applied to a material of a part that was read.
  const AppliedRows& applied() const { return applied_; }

 private:
  std::unique_ptr<ImportParts> parts_;
  const MaterialMap& map_;
  AppliedRows applied_;
};

}  // namespace runstone
