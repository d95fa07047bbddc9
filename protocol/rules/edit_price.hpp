// EditPrice: what an edit costs its player. The server takes the price from the budgets of the
// player's key and address before it checks the edit any further. The client knows its budget from
// Welcome and the prices from here, so it predicts what the server will refuse.
#pragma once
#include <cstdint>

#include "common/edits/descriptor/edit_descriptor.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The table of prices, in units. A unit is about what a click costs: one log record and one
/// changed chunk, together up to 5 KB that the disk writes.
struct EditPrices {
  /// Each chunk that the bounding box of the edit touches, up to kTouchedChunksMax. The chunk gets
  /// a new version, is swept, and is written once with the next snapshots.
  static constexpr std::uint64_t kChunk = 1;
  /// Each started kClipboardBytes of a clipboard or of a change of rights. The bytes are written to
  /// the log twice. Those of a clipboard are also kept in memory until all touched chunks are
  /// loaded, and sent to every session that sees the edit.
  static constexpr std::uint64_t kClipboardPart = 1;
  static constexpr std::size_t kClipboardBytes = 64;
};

/// Returns the price of an edit, at least 1. An edit that costs more than the whole budget costs
/// the whole budget. Cost: O(1); stroke: O(points).
std::uint64_t edit_price(const EditDescriptor& edit, std::uint16_t chunk_edge,
                         const EditBudget& budget);

}  // namespace runstone
