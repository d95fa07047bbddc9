// JoinedSource: several sources one after another, as one action.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "client/build/edit_source.hpp"

namespace runstone {

/// True if the edits of a part need those of the part before it: a move clears the old place only if
/// the copy was placed.
enum class PartOrder : std::uint8_t { free, after_all_before };

class JoinedSource final : public EditSource {
 public:
  void add(std::unique_ptr<EditSource> part, PartOrder order = PartOrder::free) {
    parts_.push_back({std::move(part), order, false});
  }
  SourceStep next() override {
    for (; at_ < parts_.size(); ++at_) {
      Part& part = parts_[at_];
      if (!std::exchange(part.has_begun, true) && part.order == PartOrder::after_all_before)
        return SourceStep::after_all();
      SourceStep step = part.source->next();
      if (step.kind != SourceStep::Kind::end) return step;
    }
    return SourceStep::done();
  }
  std::uint64_t voxels() const override {
    std::uint64_t sum = 0;
    for (const Part& part : parts_) sum += part.source->voxels();
    return sum;
  }

 private:
  struct Part {
    std::unique_ptr<EditSource> source;
    PartOrder order;
    bool has_begun;
  };
  std::vector<Part> parts_;
  std::size_t at_ = 0;
};

}  // namespace runstone
