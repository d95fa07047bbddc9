// SliceEdits: the edits that a restore job writes in one step. Fills of neighbouring chunks become
// one edit, so a large fill that is taken back has about as many edits as it had. Thread: the world
// strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/world/world_server.hpp"

namespace runstone {

class SliceEdits {
 public:
  /// `world` must outlive the object. `author`: whose role limits the edits; 0: the server.
  SliceEdits(const WorldServer& world, AuthorId author, std::int32_t chunk_edge)
      : world_(world), author_(author), chunk_edge_(chunk_edge) {}

  /// Adds an edit. A fill is merged into the fill before it if
  ///   - the two share a whole side, and have equal materials, masks and subjects, and
  ///   - the role of the author allows both as one edit.
  void add(const EditDescriptor& edit, Sequence subject);
  /// Returns edit_work() of all edits together.
  std::size_t work() const { return work_; }
  std::span<const EditDescriptor> edits() const { return edits_; }
  Sequence subject(std::size_t i) const { return subjects_[i]; }
  /// Returns how many of the edits that were added are in the first `count` of edits().
  std::size_t added_in(std::size_t count) const;

 private:
  /// Returns the last edit and this one as one edit, or nullopt.
  std::optional<EditDescriptor> with_last(const EditDescriptor& edit) const;

  const WorldServer& world_;
  AuthorId author_;
  std::int32_t chunk_edge_;
  std::vector<EditDescriptor> edits_;
  std::vector<Sequence> subjects_;
  std::vector<std::size_t> parts_;  // the edits that were added, in each
  std::size_t work_ = 0;
};

}  // namespace runstone
