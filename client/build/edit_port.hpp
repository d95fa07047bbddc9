// EditPort: what an ActionSender needs of the session that carries its edits. ClientSession and
// HeadlessSession have one each; tests have their own.
#pragma once
#include <cstddef>
#include <string>

#include "client/replica/local_edits.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

class EditPort {
 public:
  virtual ~EditPort() = default;

  /// Returns an empty text, or why nothing can be offered now: no connection, the past is shown, the
  /// server's disk is full. It passes with time.
  virtual std::string why_closed() const = 0;
  /// Returns the number of edits that an action may have. Without the feature large actions it is
  /// kActionEditsMax, and the rest is another action.
  virtual std::size_t action_edits_max() const = 0;
  /// Returns true if the edit fits the window: the edits of actions that may be under way.
  virtual bool has_room(const EditDescriptor& edit) const = 0;
  /// Returns how long the edit waits for the player's budget, so that clicks of the player still find
  /// a part of it.
  virtual TimeUs wait_us(const EditDescriptor& edit, TimeUs now_us) = 0;
  /// Shows the edit and offers it to the server. Fails with words for the player if it is refused
  /// here; no client sequence is used then.
  virtual Result<ClientSequence, std::string> offer(const EditDescriptor& edit,
                                                    const InAction& in_action, TimeUs now_us) = 0;
  /// Returns true if the server has answered the edit, or if it is not kept any more.
  virtual bool is_answered(ClientSequence seq) const = 0;
};

}  // namespace runstone
