// EditPrice: what an edit costs its player. The server takes the price from the budgets of the
// player's key and address before it checks the edit any further. The client knows its budget from
// Welcome and the prices from here, so it predicts what the server will refuse or delay.
#pragma once
#include <cstdint>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The table of prices, in units. A unit is about what a click costs the server and those who see it:
/// a log record, a changed chunk that a later snapshot writes, up to 5 KB on the disk together, and a
/// message for each session.
///
///   | for                        | units | why                                                        |
///   | each touched chunk         | 1     | it gets a new version, is swept, meshed and sent as a tile |
///   |                            |       | again, and is written once with the next snapshots         |
///   | each started 512 bytes of  | 1     | the log writes 1 KB, a fifth of what a click writes; each  |
///   | a clipboard                |       | session gets 512 bytes, about three messages of a click,   |
///   |                            |       | and applies some 250 runs. LargeEditPace bounds what all   |
///   |                            |       | players send together, so the price need not               |
///   | each 64 bytes of a change  | 1     | every server and session keeps it as long as it is in      |
///   | of rights                  |       | force, and every decision about an edit reads it           |
struct EditPrices {
  static constexpr std::uint64_t kChunk = 1;  // up to kTouchedChunksMax chunks
  static constexpr std::uint64_t kClipboardPart = 1;
  static constexpr std::size_t kClipboardBytes = 512;
  /// Of a server without the feature large actions.
  static constexpr std::size_t kClipboardBytesBefore = 64;
  static constexpr std::size_t kRightsBytes = 64;
};

/// Returns the price of an edit, at least 1. An edit that costs more than the whole budget costs
/// the whole budget. `clipboard_bytes` is EditPrices::kClipboardBytes, or for a client of a server
/// without the feature large actions kClipboardBytesBefore. Cost: O(1); stroke: O(points).
std::uint64_t edit_price(const EditDescriptor& edit, std::uint16_t chunk_edge,
                         const EditBudget& budget,
                         std::size_t clipboard_bytes = EditPrices::kClipboardBytes);

}  // namespace runstone
