// The message by which a server shows what a rollback would change (feature bit 8).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

/// The edits that the rollback of a preview would write, for the client that gave the command
/// `rollback preview`. It precedes the last output of that command.
struct RestorePreview {
  std::uint32_t command = 0;  // id of the CommandRequest
  std::string preview;        // for `rollback apply`; 0 .. 32 bytes, empty if nothing would change
  std::uint64_t voxels = 0, chunks = 0;  // that would change, in view or not
  /// Edits in the view of the session, those near its centre first. kRestorePreviewEditsMax at
  /// most.
  std::vector<EditDescriptor> edits;
  bool is_cut = false;  // edits in the view are missing, because there is no room for them
  friend bool operator==(const RestorePreview&, const RestorePreview&) = default;
};

}  // namespace runstone
