#include "server/world/server_edits.hpp"

#include <algorithm>
#include <optional>

#include "common/core/assert.hpp"
#include "protocol/rules/edit_price.hpp"
#include "server/world/broadcast.hpp"
#include "server/world/quotas.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

/// Returns who pays for edits of an author: its key, and the address of its first session. Returns
/// nullopt if nobody has the number.
std::optional<Payer> payer_of(const WorldState& world, AuthorId author) {
  const std::optional<PublicKey> key = world.players.key_of(author);
  if (!key) return std::nullopt;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open && session.author == author)
      return edit_payer(world, *key, session.address);
  }
  return edit_payer(world, *key, std::nullopt);
}

void commit_all(WorldState& world, const Clocks& now) {
  while (commit_and_broadcast(world, LargeEdits::paced, now)) {
  }
}

}  // namespace

ServerEditsResult order_server_edits(WorldState& world, const std::vector<EditOffer>& offers,
                                     AuthorId payer, const Clocks& now) {
  using State = ServerEditsResult::State;
  commit_all(world, now);
  if (!accepts_edits(world)) return {State::closed};
  if (offers.empty()) return {};
  // Instances are public, so a client of the author can join with this one and use its client
  // sequences.
  if (world.authority.resolved().knows(offers.front().op) || offers.back().op.seq > kSequenceMax)
    return {State::taken};
  const std::optional<Payer> paying = payer_of(world, payer);
  ServerEditsResult out;
  for (const EditOffer& offer : offers) {
    RUNSTONE_ASSERT(offer.cause != Cause::player);
    if (!world.environment.log_has_room(world.authority.queue().size() + 1)) {
      out.reason = world.disk_is_full ? kDiskIsFull : "the log has no room now (log_queue_records)";
      break;
    }
    if (is_memory_full(world)) {
      out.reason = kMemoryIsFull;
      break;
    }
    if (paying) {
      const std::uint64_t price = edit_price(offer.edit, world.config.chunk_edge, paying->budget);
      if (const auto unpaid = world.edit_ledger.charge(*paying, price, now.steady_us)) {
        out.reason = "the player's edit budget is used up (builder_budget)";
        break;
      }
    }
    const auto refusal = world.authority.submit(offer);
    RUNSTONE_ASSERT(!refusal);
    ++out.count;
  }
  if (out.count < offers.size()) out.state = State::busy;
  commit_all(world, now);
  return out;
}

}  // namespace runstone
