#include "server/world/commit/changes.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/utc_text.hpp"
#include "common/materials/look_on_shape.hpp"
#include "common/textures/texture_hash.hpp"
#include "protocol/rules/edit_price.hpp"

namespace runstone {
namespace {

Unexpected<MaterialsRefusal> refusal(std::string what,
                                     std::optional<std::size_t> row = std::nullopt) {
  return {{std::move(what), row}};
}

constexpr const char* kNoRoomInLog = "the log has no room now (log_queue_records)";

/// Returns why a change was not ordered, as a sentence for the one who makes it. Requires that it
/// was not.
std::string why_not_ordered(const ServerEditsResult& result) {
  switch (result.state) {
    case ServerEditsResult::State::closed:
      return "the world takes no changes any more";
    case ServerEditsResult::State::taken:
      return "the player's client uses sequence numbers of the server: join again";
    default:
      return std::string(result.reason) + ": try again later";
  }
}

}  // namespace

/// Returns who pays for edits of an author: its key, and the address of its first session. Returns
/// nullopt if nobody has the number.
std::optional<Payer> Changes::payer_of(AuthorId author) const {
  const std::optional<PublicKey> key = order_.players().key_of(author);
  if (!key) return std::nullopt;
  for (const Session* session : sessions_.open()) {
    if (session->author == author) return quotas_.edit_payer(*key, session->address);
  }
  return quotas_.edit_payer(*key, std::nullopt);
}

/// Returns true for those whose changes take rights from others.
bool Changes::has_power(const RightsActor& actor) const {
  if (!actor.key || actor.is_operator) return true;
  const RightSet rights = rights_.state().role_of(*actor.key).rights;
  return rights.has(Right::moderate) || rights.has(Right::protect) || rights.has(Right::grant) ||
         rights.has(Right::administer);
}

std::optional<const char*> Changes::why_full(DiskNeed need, std::size_t records) const {
  const bool has_room =
      need == DiskNeed::space ? order_.log_has_room(records) : order_.log_has_queue_room();
  if (!has_room) return order_.is_disk_full() ? order_.disk_reason() : kNoRoomInLog;
  return order_.is_memory_full() ? std::optional(kMemoryIsFull) : std::nullopt;
}

ServerEditsResult Changes::order_edits(const std::vector<EditOffer>& offers, AuthorId payer,
                                       const Clocks& now) {
  return order(offers, payer, DiskNeed::space, now);
}

ServerEditsResult Changes::order(const std::vector<EditOffer>& offers, AuthorId payer,
                                 DiskNeed need, const Clocks& now) {
  using State = ServerEditsResult::State;
  commits_.commit_all(LargeEdits::paced, now);
  if (!order_.accepts_edits()) return {State::closed};
  if (offers.empty()) return {};
  // Instances are public, so a client of the author can join with this one and use its client
  // sequences.
  if (order_.authority().resolved().knows(offers.front().op) || offers.back().op.seq > kSequenceMax)
    return {State::taken};
  const std::optional<Payer> paying = payer_of(payer);
  ServerEditsResult out;
  for (const EditOffer& offer : offers) {
    RUNSTONE_ASSERT(offer.cause != Cause::player || offer.is_of_large_action);
    if (const auto why = why_full(need, 1)) {
      out.reason = *why;
      break;
    }
    if (paying) {
      const std::uint64_t price = edit_price(offer.edit, config_.chunk_edge, paying->budget);
      if (const auto unpaid = quotas_.charge_edit(*paying, price, now.steady_us)) {
        out.reason = "the player's edit budget is used up (builder_budget)";
        break;
      }
    }
    if (offer.is_of_large_action && offer.op.seq == offer.action)
      order_.authority().large_actions().begin(offer.op);
    const auto queued = order_.authority().enqueue(offer);
    RUNSTONE_ASSERT(queued.has_value());
    ++out.count;
  }
  if (out.count < offers.size()) out.state = State::busy;
  commits_.commit_all(LargeEdits::paced, now);
  return out;
}

Result<Sequence, std::string> Changes::change_rights(const RightsChange& change,
                                                     const RightsActor& actor, AuthorId author,
                                                     const Clocks& now) {
  if (auto why = rights_.change_refusal(change, actor)) return failure(*why);
  if (author != 0 && !order_.players().key_of(author)) return failure("the player has left");
  // What waits was allowed, and is ordered before the change that may forbid it. A claim does not
  // hurry: players could use it to send large edits faster than others.
  const bool is_powerful = has_power(actor);
  if (is_powerful) commits_.commit_all(LargeEdits::all, now);
  const OperationId op = order_.next_own_operation(author);
  const EditOffer offer{op, Cause::rights, now.steady_us, rights_edit(change), 0};
  const ServerEditsResult ordered =
      order({offer}, author, is_powerful ? DiskNeed::none : DiskNeed::space, now);
  if (ordered.state == ServerEditsResult::State::ordered) return rights_.newest();
  return failure(why_not_ordered(ordered));
}

std::optional<CorrectTime> Changes::time_correction() const {
  const Authority& authority = std::as_const(order_).authority();
  const LogClock& clock = authority.log_clock();
  const CorrectTime change{-clock.ahead_us(), authority.timed_from()};
  const bool is_needed =
      change.step_us < 0 ||
      (change.step_us > 0 && rights_.state().has_ends_given_since(change.since, clock.time()));
  return is_needed ? std::optional(change) : std::nullopt;
}

std::optional<std::string> Changes::accept_kept_jump(const std::optional<std::string>& refusal,
                                                     const Clocks& now) {
  const LogClock& clock = std::as_const(order_).authority().log_clock();
  if (!clock.is_step_due()) {
    is_jump_refused_ = false;
    return std::nullopt;
  }
  if (!order_.accepts_edits()) return std::nullopt;
  const std::string step = "the wall clock has kept its jump: the time of the log goes from " +
                           utc_text(clock.time()) + " to " + utc_text(clock.wall_us());
  const auto change = time_correction();
  if (!change) {
    accept_wall_clock();
    return step;
  }
  std::optional<std::string> why = refusal;
  if (!why) {
    const auto seq = change_rights(*change, {}, 0, now);
    if (seq) return step + " (record " + std::to_string(*seq) + ")";
    why = seq.error();
  }
  if (std::exchange(is_jump_refused_, true)) return std::nullopt;
  return "the wall clock has kept its jump, but the time of the log cannot follow without shortening "
         "bans, mutes, freezes or invites: " +
         *why;
}

ServerEditsResult Changes::order_all(const std::vector<EditOffer>& offers, const Clocks& now) {
  using State = ServerEditsResult::State;
  commits_.commit_all(LargeEdits::paced, now);
  if (!order_.accepts_edits()) return {State::closed};
  if (const auto why = why_full(DiskNeed::space, offers.size())) return {State::busy, 0, *why};
  for (const EditOffer& offer : offers) {
    const auto queued = order_.authority().enqueue(offer);
    RUNSTONE_ASSERT(queued.has_value());
  }
  // One commit takes all of them, up to kCommitEditsMax (edit_work()), and the log writer writes it
  // in one transaction.
  commits_.commit_all(LargeEdits::paced, now);
  return {State::ordered, offers.size()};
}

void Changes::offer_shapes(std::span<const GivenShape> rows, const Clocks& now,
                           std::vector<EditOffer>& offers) {
  while (!rows.empty()) {
    GivenShapes given = first_of(rows);
    rows = rows.subspan(given.rows.size());
    const OperationId op = order_.next_own_operation(0);
    offers.push_back({op, Cause::materials, now.steady_us, shapes_edit(std::move(given)), 0});
  }
}

Result<AddedAt, MaterialsRefusal> Changes::add_materials(const std::vector<MaterialRow>& rows,
                                                         const Clocks& now) {
  const MaterialTable& table = order_.materials();
  if (rows.empty() || rows.size() > kAddedMaterialsMax) {
    return refusal(std::to_string(rows.size()) + " materials: 1 to " +
                   std::to_string(kAddedMaterialsMax) + " can be added at a time");
  }
  if (const auto sound = table.check_rows(rows); !sound)
    return refusal(sound.error().what, static_cast<std::size_t>(sound.error().offset));
  const auto first = static_cast<Material>(table.size());
  AddedMaterials added{first, rows};
  std::vector<GivenShape> given;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    added.rows[i] = with_look_on_shape(rows[i]);
    added.rows[i].shape = {};
    if (!rows[i].shape.is_cube())
      given.push_back({static_cast<Material>(first + i), rows[i].shape});
  }
  const OperationId op = order_.next_own_operation(0);
  std::vector<EditOffer> offers = {
      {op, Cause::materials, now.steady_us, materials_edit(std::move(added)), 0}};
  offer_shapes(given, now, offers);
  const ServerEditsResult ordered = order_all(offers, now);
  if (ordered.state != ServerEditsResult::State::ordered) return refusal(why_not_ordered(ordered));
  return AddedAt{order_.newest_materials(), first};
}

Result<Sequence, std::string> Changes::give_shapes(std::vector<GivenShape> rows,
                                                   const Clocks& now) {
  RUNSTONE_ASSERT(!rows.empty());
  std::ranges::sort(rows, {}, &GivenShape::material);
  if (const auto fits = order_.materials().check_given(rows); !fits)
    return failure(std::string(fits.error().what));
  std::vector<EditOffer> offers;
  offer_shapes(rows, now, offers);
  const ServerEditsResult ordered = order_all(offers, now);
  if (ordered.state != ServerEditsResult::State::ordered) return failure(why_not_ordered(ordered));
  return order_.newest_materials();
}

Result<Sequence, std::string> Changes::give_textures(std::span<const GivenTexturePtr> textures,
                                                     const Clocks& now) {
  RUNSTONE_ASSERT(!textures.empty());
  const MaterialTable& materials = order_.materials();
  TextureTable table = order_.textures().table();
  std::vector<EditOffer> offers;
  for (const GivenTexturePtr& given : textures) {
    const auto fits = table.add(texture_entry(given->png, given->uses, given->hash));
    // The uses ascend by material.
    if (fits && !materials.knows(given->uses.back().material))
      return failure("the world has no material " + std::to_string(given->uses.back().material));
    if (!fits && fits.error().code == ErrorCode::not_permitted) {
      const auto id = static_cast<Material>(fits.error().offset);
      return failure("a side of \"" + (materials.knows(id) ? materials[id].name : "?") +
                     "\" has a picture already, which stays for ever");
    }
    if (!fits) return failure(std::string(fits.error().what));
    const OperationId op = order_.next_own_operation(0);
    const EditDescriptor edit{TextureEdit{given}, {}, kEmpty};
    offers.push_back({op, Cause::textures, now.steady_us, edit, 0});
  }
  const ServerEditsResult ordered = order_all(offers, now);
  if (ordered.state != ServerEditsResult::State::ordered) return failure(why_not_ordered(ordered));
  return order_.textures().newest();
}

Result<Sequence, std::string> Changes::set_clock(const WorldTime& time, AuthorId author,
                                                 const Clocks& now) {
  if (author != 0 && !order_.players().key_of(author)) return failure("the player has left");
  const OperationId op = order_.next_own_operation(author);
  const EditOffer offer{op, Cause::clock, now.steady_us, clock_edit(time), 0};
  const ServerEditsResult ordered = order_edits({offer}, author, now);
  if (ordered.state != ServerEditsResult::State::ordered) return failure(why_not_ordered(ordered));
  return order_.clock().record();
}

Result<Sequence, std::string> Changes::change_library(const LibraryChange& change, AuthorId author,
                                                      const Clocks& now) {
  if (author != 0 && !order_.players().key_of(author)) return failure("the player has left");
  const OperationId op = order_.next_own_operation(author);
  const EditOffer offer{op, Cause::library, now.steady_us, library_edit(change), 0};
  const ServerEditsResult ordered = order_edits({offer}, author, now);
  if (ordered.state == ServerEditsResult::State::ordered) return order_.library().newest();
  return failure(why_not_ordered(ordered));
}

Result<Sequence, std::string> Changes::add_build(const AddBuild& build, AuthorId author,
                                                 const Clocks& now) {
  if (auto why = order_.library().refusal(author, build.file_bytes)) return failure(*why);
  return change_library(build, author, now);
}

Result<Sequence, std::string> Changes::remove_build(Sequence number, AuthorId author,
                                                    const Clocks& now) {
  if (order_.library().find(number) == nullptr)
    return failure("the library has no build " + std::to_string(number));
  return change_library(RemoveBuild{number}, author, now);
}

}  // namespace runstone
