// EditSource: the edits of one action, made one by one when there is room to send them. So an action
// may have any number of edits, and takes the memory of few. Pure: no clock and no socket. One
// thread.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// The next thing that a source has.
struct SourceStep {
  enum class Kind : std::uint8_t {
    edit,     // `edit` is the next one
    wait,     // the next edit is not known yet: ask later. `why` says for what it waits
    barrier,  // the edits that follow are sent when all before it are answered and none is refused
    end,      // there are no more edits
    failed,   // there are no more edits, although some are missing: `why` says why
  };
  Kind kind = Kind::end;
  EditDescriptor edit{};
  std::string why{};  // for the player, of `wait` and `failed`

  static SourceStep of(EditDescriptor edit) { return {Kind::edit, std::move(edit), {}}; }
  /// `what` says for what the edit waits.
  static SourceStep later(std::string what) { return {Kind::wait, {}, std::move(what)}; }
  static SourceStep after_all() { return {Kind::barrier, {}, {}}; }
  static SourceStep done() { return {}; }
  static SourceStep failure(std::string why) { return {Kind::failed, {}, std::move(why)}; }
};

class EditSource {
 public:
  EditSource() = default;
  virtual ~EditSource() = default;
  EditSource(const EditSource&) = delete;
  EditSource& operator=(const EditSource&) = delete;

  /// Returns the next step. The edits are legal: valid, and within the limits of the world. After
  /// `end` or `failed` it returns that again.
  virtual SourceStep next() = 0;
  /// Returns the number of voxels of all edits, as counted_voxels() counts them, or an estimate. It
  /// serves the progress. 0: not known.
  virtual std::uint64_t voxels() const = 0;
};

}  // namespace runstone
