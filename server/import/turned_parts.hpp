// TurnedParts: the parts of another ImportParts, turned by quarter turns. It is for a source of one
// part, whose lowest corner stays.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/clipboard/orientation.hpp"
#include "server/import/import_parts.hpp"

namespace runstone {

class TurnedParts final : public ImportParts {
 public:
  TurnedParts(std::unique_ptr<ImportParts> parts, const Orientation& orientation)
      : parts_(std::move(parts)), orientation_(orientation) {}

  std::size_t count() const override { return parts_->count(); }
  Result<std::optional<ImportPart>, std::string> read(std::size_t index,
                                                      ImportFaults& faults) override;
  std::vector<std::string> notices() const override;

 private:
  std::unique_ptr<ImportParts> parts_;
  Orientation orientation_;
  std::size_t stuck_ = 0;  // materials of the part that was read last
};

}  // namespace runstone
