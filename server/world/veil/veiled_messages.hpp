// The messages that carry changes of shown chunks to veiled sessions.
#pragma once
#include <span>

#include "protocol/codec/messages.hpp"
#include "server/world/order/authority.hpp"
#include "server/world/veil/shown_edit.hpp"

namespace runstone {

/// Returns the commit of veiled sessions, with an entry for each edit of the batch. The entry of a
/// hidden edit is the receipt of its client: it may be sent to nobody else. `shown`: what
/// ShownChunks::apply() has returned for the batch. The result is not bounded: an edit of thousands
/// of chunks may have more than kVeilPatchesMax patches, or more bytes than a message may have. The
/// encoder requires that both fit.
VeiledCommit veiled_commit(const OrderedBatch& batch, std::span<const ShownEdit> shown);

/// Returns the message with patches that no edit has caused. Requires at least one patch, and that
/// all chunks get one version.
VeilPatches veil_patches(std::span<const ShownPatch> patches);

}  // namespace runstone
