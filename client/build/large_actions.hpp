// LargeActions: who sends the actions that are too large to be proposed at once. A session that
// carries edits has one; tests have their own.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "client/build/edit_source.hpp"
#include "common/core/result.hpp"

namespace runstone {

class LargeActions {
 public:
  virtual ~LargeActions() = default;

  /// Begins to send the edits of an action. `name` is what its progress is called, such as "paste".
  /// Fails with words for the player if it cannot begin now, for example because another one is under
  /// way.
  virtual Result<void, std::string> begin(std::unique_ptr<EditSource> edits,
                                          const std::string& name) = 0;
  /// Returns nullopt while the action that was begun last is under way, and then how it ended: it
  /// fails with words for the player if a part was refused or it was cancelled. Requires begin().
  virtual std::optional<Result<void, std::string>> end() const = 0;
};

}  // namespace runstone
