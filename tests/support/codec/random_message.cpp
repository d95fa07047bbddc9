#include "tests/support/codec/random_message.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "common/core/m61.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/veil/veil.hpp"
#include "tests/support/core/random_look.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/rights/random_rights.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

// Small and large values are equally frequent: a shift spreads the draw over all magnitudes.
std::uint64_t any64(SplitMix64& rng) { return rng.next() >> rng.below(64); }
std::int64_t any_time(SplitMix64& rng) {
  return static_cast<std::int64_t>(rng.next()) >> (10 + rng.below(53));  // within kWireTimeUsMax
}

template <std::size_t N>
void draw(SplitMix64& rng, std::array<std::uint8_t, N>& out) {
  for (auto& byte : out) byte = static_cast<std::uint8_t>(rng.next());
}

std::string any_text(SplitMix64& rng, std::size_t bytes_min, std::size_t bytes_max) {
  static constexpr const char* kPieces[] = {
      "a", "Z", " ", "7", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\xa7\xb1"};
  std::string out;
  const auto target = static_cast<std::size_t>(
      rng.between(static_cast<std::int32_t>(bytes_min), static_cast<std::int32_t>(bytes_max)));
  while (out.size() < target) {
    const std::string piece = kPieces[rng.below(7)];
    out += out.size() + piece.size() <= bytes_max ? piece : "x";
  }
  return out;
}

std::string any_name(SplitMix64& rng) {
  std::string out = any_text(rng, 1, kPlayerNameBytesMax);
  if (out.front() == ' ') out.front() = 'x';
  if (out.back() == ' ') out.back() = 'x';
  return out;
}

ChunkCoord any_coord(SplitMix64& rng) {
  constexpr std::int32_t kReach = kWorldLimit / kMessageEdge;
  return {rng.between(-kReach, kReach - 1), rng.between(-40, 40), rng.between(-kReach, kReach - 1)};
}

Version any_version(SplitMix64& rng) {
  if (rng.below(4) == 0) return {};
  return {1 + rng.below(1000), 1 + (any64(rng) >> 1)};
}

Digest any_digest(SplitMix64& rng) { return {{m61::reduce(rng.next()), m61::reduce(rng.next())}}; }

WorldPos any_position(SplitMix64& rng) {
  const auto c = [&rng] {
    return rng.between(-kWorldLimit, kWorldLimit) / 8.0 + rng.below(1000) / 1024.0;
  };
  return {c(), c(), c()};
}

Pose any_pose(SplitMix64& rng) {
  return {any_position(rng), static_cast<std::uint16_t>(rng.next()),
          static_cast<std::int16_t>(rng.next())};
}

EditDescriptor any_edit(SplitMix64& rng) {
  const VoxelPos at{rng.between(-1'000'000, 1'000'000), rng.between(-300, 300),
                    rng.between(-1'000, 1'000)};
  EditDescriptor edit;
  switch (rng.below(5)) {
    case 3:
      edit.shape = Paste{at, random_clipboard(rng, 9, rng.below(2) == 0 ? 3 : 65536),
                         random_orientation(rng)};
      break;
    case 0:
      edit.shape = SetVoxel{at};
      break;
    case 1:
      edit.shape = random_stroke(rng, at);
      break;
    case 2:
      edit.shape = FillBox{
          {at, {at.x + rng.between(1, 60), at.y + rng.between(1, 60), at.z + rng.between(1, 60)}}};
      break;
    default:
      edit.shape = FillSphere{at, static_cast<std::uint16_t>(rng.below(40))};
  }
  edit.mask.kind = static_cast<MaskKind>(rng.below(4));
  if (edit.mask.kind == MaskKind::only_material)
    edit.mask.material = static_cast<Material>(rng.next());
  if (!std::holds_alternative<Paste>(edit.shape)) edit.material = static_cast<Material>(rng.next());
  return edit;
}

Shape any_shape(SplitMix64& rng) {
  Shape shape;
  shape.form = static_cast<ShapeForm>(rng.below(2));
  for (std::uint32_t left = 1 + rng.below(3); left != 0; --left) {
    ShapeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<std::uint8_t>(rng.below(kShapeUnits));
      box.max[axis] = static_cast<std::uint8_t>(
          box.min[axis] + 1 + rng.below(std::uint32_t{kShapeUnits} - box.min[axis]));
    }
    shape.boxes.push_back(box);
  }
  return shape;
}

WorldTime any_world_time(SplitMix64& rng) {
  return {rng.below(kDayMs), rng.below(2) == 0 ? 0 : rng.below(kTimeRateMax + 1)};
}

GivenShapes any_given_shapes(SplitMix64& rng) {
  GivenShapes given;
  const std::vector<Shape> shapes = {any_shape(rng), any_shape(rng)};
  Material material = kEmpty;
  for (std::uint32_t left = 1 + rng.below(9); left != 0; --left) {
    material = static_cast<Material>(material + 1 + rng.below(700));
    given.rows.push_back({material, shapes[rng.below(2)]});
  }
  return given;
}

TextureHash any_texture_hash(SplitMix64& rng) {
  TextureHash hash;
  draw(rng, hash);
  return hash;
}

std::vector<TextureUse> any_texture_uses(SplitMix64& rng) {
  std::vector<TextureUse> uses;
  Material material = kEmpty;
  for (std::uint32_t left = 1 + rng.below(9); left != 0; --left) {
    material = static_cast<Material>(material + 1 + rng.below(700));
    uses.push_back({material, static_cast<std::uint8_t>(1 + rng.below(kAllTextureSides))});
  }
  return uses;
}

/// Returns a texture whose picture has a sound head and nothing behind it.
GivenTexture any_given_texture(SplitMix64& rng) {
  const auto edge = static_cast<std::uint8_t>(16U << rng.below(3));
  GivenTexture given{{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0, 0, 13, 'I', 'H', 'D',
                      'R',  0,   0,   0,   edge, 0,    0,    0,    edge, 8, 6, 0,  0,   0},
                     any_texture_uses(rng)};
  for (std::uint32_t left = rng.below(100); left != 0; --left)
    given.png.push_back(static_cast<std::uint8_t>(rng.next()));
  return given;
}

TexturesGiven any_textures_given(SplitMix64& rng) {
  TexturesGiven m;
  for (std::uint32_t left = 1 + rng.below(20); left != 0; --left) {
    m.entries.push_back({any_texture_hash(rng),
                         1 + rng.below(static_cast<std::uint32_t>(kTextureBytesMax)),
                         any_texture_uses(rng)});
  }
  return m;
}

TexturesWanted any_textures_wanted(SplitMix64& rng) {
  TexturesWanted m;
  for (std::uint32_t left = 1 + rng.below(kTexturesWantedMax); left != 0; --left)
    m.hashes.push_back(any_texture_hash(rng));
  return m;
}

TextureParts any_texture_parts(SplitMix64& rng) {
  TextureParts m;
  for (std::uint32_t left = 1 + rng.below(9); left != 0; --left) {
    TexturePart part{any_texture_hash(rng), {}};
    part.png.resize(rng.below(2000));
    for (std::uint8_t& byte : part.png) byte = static_cast<std::uint8_t>(rng.next());
    m.parts.push_back(std::move(part));
  }
  return m;
}

MaterialTable any_materials(SplitMix64& rng, bool with_shapes = false) {
  MaterialTable table;
  const std::uint32_t count = rng.below(20);
  for (std::uint32_t i = 0; i < count; ++i) {
    MaterialInfo info;
    info.name = std::to_string(i) + any_text(rng, 0, 50);
    draw(rng, info.colour);
    info.visibility = static_cast<Visibility>(rng.below(3));
    if (info.visibility == Visibility::opaque) info.colour[3] = 255;
    if (info.visibility != Visibility::empty) info.body = static_cast<MaterialBody>(rng.below(3));
    if (rng.below(2) == 0) info.look = random_look(rng);
    if (with_shapes && info.visibility != Visibility::empty && rng.below(2) == 0)
      info.shape = any_shape(rng);
    RUNSTONE_ASSERT(table.add(std::move(info)).has_value());
  }
  return table;
}

Hello any_hello(SplitMix64& rng) {
  Hello m;
  draw(rng, m.key);
  m.instance = any64(rng);
  draw(rng, m.nonce);
  m.name = any_name(rng);
  m.encodings = static_cast<std::uint8_t>(rng.below(32) * 8 + 1 + rng.below(7));
  m.features = any64(rng);
  return m;
}

Budget any_budget(SplitMix64& rng) {
  if (rng.below(2) == 0) return {};
  return {1 + (any64(rng) >> 1), 1 + (any64(rng) >> 1)};
}

Welcome any_welcome(SplitMix64& rng) {
  Welcome m;
  draw(rng, m.world_id);
  m.epoch = 1 + rng.below(1'000'000);
  m.head = any64(rng);
  m.durable = m.head - m.head / (1 + rng.below(9));
  m.chunk_edge = static_cast<std::uint16_t>(16u << rng.below(4));
  m.heights = {rng.between(-1000, 0), rng.between(1, 1000)};
  m.spawn = any_position(rng);
  draw(rng, m.server_key);
  draw(rng, m.challenge);
  draw(rng, m.signature);
  m.encoding = static_cast<ChunkEncoding>(1 + rng.below(3));
  m.edit_volume_max = any64(rng);
  m.edit_budget = any_budget(rng);
  m.view_radius_max = static_cast<std::uint8_t>(rng.below(kViewRadiusMax + 1));
  m.features = any64(rng);
  m.materials = any_materials(rng, (m.features & kFeatureShapes) != 0);
  if (rng.below(2) == 0) draw(rng, m.password_salt.emplace());
  m.waiting_edits_max = 1 + rng.below(1'000);
  m.waiting_edit_bytes_max = kWaitingEditBytesMax + rng.below(1'000);
  return m;
}

ClientAuth any_client_auth(SplitMix64& rng) {
  ClientAuth m;
  if (rng.below(2) == 0) m.ticket = any_text(rng, 1, kTicketBytesMax);
  draw(rng, m.signature);
  if (rng.below(2) == 0) draw(rng, m.password_key.emplace());
  return m;
}

/// Returns strictly ascending keys of one level of detail, some of them neighbours.
std::vector<ChunkKey> ascending_keys(SplitMix64& rng, std::size_t count_max,
                                     std::uint8_t level = 0) {
  std::set<ChunkKey> keys;
  ChunkCoord at = any_coord(rng);
  for (std::uint32_t i = 1 + rng.below(static_cast<std::uint32_t>(count_max)); i > 0; --i) {
    at = rng.below(3) == 0 ? any_coord(rng) : ChunkCoord{at.x, at.y, std::max(at.z - 1, -1000)};
    keys.insert(tile_of(at, level));
  }
  return {keys.begin(), keys.end()};
}

std::uint8_t any_level(SplitMix64& rng) {
  return static_cast<std::uint8_t>(rng.below(2) == 0 ? 0 : rng.below(kTileLevelMax + 1U));
}

std::uint32_t any_view_number(SplitMix64& rng) { return 1 + rng.below(1'000'000); }

View any_view(SplitMix64& rng) {
  return {any_view_number(rng),
          any_coord(rng),
          static_cast<std::uint8_t>(rng.below(kViewRadiusMax + 1)),
          static_cast<std::uint8_t>(rng.below(kViewRadiusMax + 1)),
          static_cast<std::uint16_t>(rng.next()),
          static_cast<std::int16_t>(rng.next()),
          static_cast<std::uint16_t>(rng.below(kViewConeMax + 1U)),
          any_level(rng)};
}

ChunkRequest any_chunk_request(SplitMix64& rng) {
  return {ascending_keys(rng, kChunkRequestKeysMax)};
}

ChunkUnavailable any_unavailable(SplitMix64& rng) {
  return {any_view_number(rng), ascending_keys(rng, kUnavailableKeysMax),
          static_cast<UnavailableReason>(1 + rng.below(255))};
}

HistoryRequest any_history_request(SplitMix64& rng) {
  HistoryRequest m;
  m.request = 1 + rng.below(1'000'000);
  m.to = static_cast<HistoryTarget>(rng.below(kHistoryTargetMax + 1u));
  if (m.to == HistoryTarget::sequence) m.seq = any64(rng) >> 1;
  if (m.to == HistoryTarget::time) m.utc_us = any_time(rng);
  return m;
}

ViewState any_view_state(SplitMix64& rng) {
  ViewState m;
  m.phase = static_cast<ViewPhase>(1 + rng.below(kViewPhaseMax));
  m.view = rng.below(1'000'000) + (m.phase == ViewPhase::complete ? 1 : 0);
  m.past = rng.below(2) == 0;
  const bool is_asked = m.past || m.phase == ViewPhase::refused;
  m.request = rng.below(1'000'000) + (is_asked ? 1 : 0);
  if (m.past) m.seq = any64(rng) >> 1;
  if (m.seq != 0) m.utc_us = any_time(rng);
  m.text = any_text(rng, 0, kTextBytesMax);
  return m;
}

CachedChunks any_cached_chunks(SplitMix64& rng) {
  CachedChunks m;
  for (const ChunkKey& key : ascending_keys(rng, 100, any_level(rng))) {
    m.chunks.push_back({key, any_version(rng), claim_digest(any_digest(rng))});
  }
  return m;
}

ChunksNotModified any_chunks_not_modified(SplitMix64& rng) {
  ChunksNotModified m;
  m.view = any_view_number(rng);
  for (const ChunkKey& key : ascending_keys(rng, kChunksNotModifiedMax, any_level(rng)))
    m.chunks.push_back({key, any_version(rng).seq});
  return m;
}

ChunkEdits any_chunk_edits(SplitMix64& rng, const ChunkKey& key) {
  ChunkEdits m;
  m.key = key;
  m.from = rng.below(2) == 0 ? 0 : any64(rng) >> 2;
  Sequence seq = m.from;
  for (std::uint32_t i = 1 + rng.below(6); i > 0; --i) {
    seq += 1 + rng.below(1000);
    m.edits.push_back({seq, any_edit(rng)});
  }
  m.to = {1 + rng.below(1000), seq};
  m.digest = any_digest(rng);
  return m;
}

CommandOutput any_output(SplitMix64& rng) {
  CommandOutput m;
  m.id = rng.below(1000);
  m.lines.resize(rng.below(kCommandLinesMax + 1));
  for (std::string& line : m.lines)
    line = any_text(rng, 0, rng.below(8) == 0 ? kCommandLineBytesMax : 40);
  m.is_done = rng.below(2) == 0;
  m.is_ok = rng.below(2) == 0;
  return m;
}

ChunkSnapshot any_snapshot(SplitMix64& rng, const ChunkKey& key) {
  ChunkSnapshot m;
  m.key = key;
  const AxisOrder order = random_order(rng);
  m.chunk.voxels = random_chunk(rng, Extent::cube(kMessageEdge), order, 1 + rng.below(300));
  m.chunk.version = any_version(rng);
  m.chunk.digest = digest_of(m.chunk.voxels);
  return m;
}

/// Returns up to six chunks, far fewer runs than the limit, in both forms.
Chunks any_chunks(SplitMix64& rng) {
  Chunks m;
  m.view = any_view_number(rng);
  const std::uint8_t level = any_level(rng);
  for (const ChunkKey& key : ascending_keys(rng, 6, level)) {
    if (level == 0 && rng.below(3) == 0) {
      m.chunks.emplace_back(any_chunk_edits(rng, key));
    } else {
      m.chunks.emplace_back(any_snapshot(rng, key));
    }
  }
  return m;
}

/// Draws materials and versions from few values, so that some neighbours are equal.
UniformChunks any_uniform(SplitMix64& rng) {
  UniformChunks m;
  m.view = any_view_number(rng);
  const Version version = any_version(rng);
  for (const ChunkKey& key : ascending_keys(rng, 40, any_level(rng))) {
    const auto material = static_cast<Material>(rng.below(4) == 0 ? rng.next() : rng.below(2));
    m.chunks.push_back({key, material, rng.below(4) == 0 ? any_version(rng) : version});
  }
  return m;
}

Commit any_commit(SplitMix64& rng) {
  Commit m;
  m.epoch = 1 + rng.below(1'000'000);
  Sequence seq = any64(rng) >> 2;
  m.edits.resize(1 + rng.below(6));
  for (std::size_t i = 0; i < m.edits.size(); ++i) {
    OrderedEdit& e = m.edits[i];
    seq += 1 + (rng.below(2) == 0 ? 0 : rng.below(1'000'000));
    e.seq = seq;
    e.op = {rng.below(1000), rng.next(), any64(rng)};
    // A commit has only edits with voxels.
    e.cause = static_cast<Cause>(rng.below(static_cast<std::uint32_t>(Cause::rights)));
    e.submitted_us = any_time(rng);
    e.ordered_us = any_time(rng);
    e.edit = any_edit(rng);
    if (rng.below(2) == 0) e.subject = any64(rng) % seq;
    for (std::size_t c = touched_chunks(e.edit, kMessageEdge).size(); c > 0; --c) {
      e.previous.push_back(rng.below(4) == 0 ? 0
                                             : seq - std::min<std::uint64_t>(seq, 1 + any64(rng)));
    }
  }
  return m;
}

std::vector<ChunkPatch> any_patches(SplitMix64& rng, Sequence seq, bool may_stay) {
  std::vector<ChunkPatch> out;
  const Extent extent = Extent::cube(kMessageEdge);
  for (const ChunkKey& key : ascending_keys(rng, 4)) {
    ChunkPatch patch{
        key.at, seq - std::min<Sequence>(seq, 1 + rng.below(100)), {extent, kVeilOrder, {}}};
    if (may_stay && rng.below(3) == 0) patch.previous = seq;
    // Spans that do not touch need not differ in material.
    for (VoxelIndex at = rng.below(50); at < extent.volume() - 60; at += 60 + rng.below(900))
      patch.patch.spans.push_back({at, 1 + rng.below(50), static_cast<Material>(rng.below(4))});
    out.push_back(std::move(patch));
  }
  return out;
}

VeiledCommit any_veiled_commit(SplitMix64& rng) {
  VeiledCommit m;
  Commit commit = any_commit(rng);
  m.epoch = commit.epoch;
  for (OrderedEdit& ordered : commit.edits) {
    VeiledEdit& edit = m.edits.emplace_back();
    edit.has_edit = rng.below(2) == 0;
    if (!edit.has_edit) {
      ordered.edit = {};
      ordered.previous.clear();
    }
    if (rng.below(3) != 0) edit.patches = any_patches(rng, ordered.seq, edit.has_edit);
    edit.ordered = std::move(ordered);
  }
  return m;
}

VeilPatches any_veil_patches(SplitMix64& rng) {
  VeilPatches m;
  m.version = {1 + rng.below(1000), 1 + (any64(rng) >> 2)};
  m.patches = any_patches(rng, m.version.seq, true);
  return m;
}

Reject any_reject(SplitMix64& rng) {
  Reject m;
  m.client_seq = 1 + (any64(rng) >> 1);
  m.reason = static_cast<RejectReason>(1 + rng.below(kRejectReasonMax));
  m.detail = any_text(rng, 0, kTextBytesMax);
  if (m.reason == RejectReason::already_resolved) m.seq = any64(rng);
  return m;
}

DigestCheck any_digest_check(SplitMix64& rng) {
  DigestCheck m;
  for (const ChunkKey& key : ascending_keys(rng, 20))
    m.entries.push_back({key, any_version(rng), any_digest(rng)});
  return m;
}

PlayerPoses any_poses(SplitMix64& rng) {
  PlayerPoses m;
  m.players.resize(rng.below(20));
  for (PlayerPose& p : m.players) p = {rng.below(1000), any_pose(rng)};
  return m;
}

PlayerList any_player_list(SplitMix64& rng) {
  PlayerList m;
  m.players.resize(rng.below(20));
  for (PlayerName& p : m.players) {
    p = {rng.below(1000), any_name(rng), {}, any_text(rng, 0, kGroundNameBytesMax)};
    draw(rng, p.key);
  }
  m.is_change = rng.below(2) == 0;
  if (m.is_change) m.left.resize(rng.below(20));
  for (AuthorId& author : m.left) author = rng.below(1000);
  return m;
}

Permissions any_permissions(SplitMix64& rng) {
  return {any_text(rng, 1, kGroundNameBytesMax), static_cast<std::uint32_t>(any64(rng)), any64(rng),
          any_text(rng, 0, kTextBytesMax), any_budget(rng)};
}

ProtectedGround any_ground(SplitMix64& rng) {
  ProtectedGround m;
  Sequence seq = any64(rng) >> 2;
  for (std::uint32_t i = 1 + rng.below(20); i > 0; --i) {
    seq += 1 + rng.below(1000);
    if (rng.below(3) == 0) m.removed.push_back(seq);
    if (!m.removed.empty() && rng.below(3) == 0) continue;
    const VoxelPos min{rng.between(-kWorldLimit, kWorldLimit - 1), rng.between(-300, 300), 7};
    const VoxelPos max{kWorldLimit, min.y + rng.between(1, 60), 8};
    const std::int32_t priority = rng.between(-kGroundPriorityMax, kGroundPriorityMax);
    m.boxes.push_back({seq,
                       {min, max},
                       priority,
                       rng.below(2) == 0,
                       any_text(rng, 1, kGroundNameBytesMax),
                       any_text(rng, 0, 32)});
  }
  return m;
}

ChatLines any_chat_lines(SplitMix64& rng) {
  ChatLines m;
  m.lines.resize(1 + rng.below(kChatLinesMax));
  for (ChatLine& line : m.lines) {
    line.kind = static_cast<ChatLineKind>(1 + rng.below(rng.below(4) == 0 ? 255 : 4));
    if (line.kind == ChatLineKind::player) {
      line.author = rng.below(1000);
      line.name = any_name(rng);
    }
    line.text = any_text(rng, 1, kChatBytesMax);
    line.utc_us = any_time(rng);
  }
  return m;
}

ChatWithdrawn any_chat_withdrawn(SplitMix64& rng) {
  ChatWithdrawn m;
  m.lines.resize(1 + rng.below(kChatWithdrawnMax));
  for (ChatLineId& line : m.lines) line = {any_time(rng), any_name(rng)};
  return m;
}

KeySlot any_slot(SplitMix64& rng) {
  KeySlot slot;
  draw(rng, slot);
  return slot;
}

Bytes any_sealed(SplitMix64& rng) {
  Bytes sealed(1 + rng.below(kSealedKeyBytesMax));
  for (auto& byte : sealed) byte = static_cast<std::uint8_t>(rng.next());
  return sealed;
}

MaterialsAdded any_materials_added(SplitMix64& rng) {
  MaterialTable table = any_materials(rng);
  if (table.size() == 1) RUNSTONE_ASSERT(table.add({"one", {}, Visibility::empty, {}}).has_value());
  MaterialsAdded m;
  for (const MaterialInfo& info : table.rows().subspan(1))
    m.rows.push_back({info.name, info.colour, info.visibility, info.body});
  const auto ids = static_cast<std::uint32_t>(kMaterialCountMax - m.rows.size());
  m.first = static_cast<Material>(1 + rng.below(ids));
  return m;
}

LogMarksRequest any_log_marks_request(SplitMix64& rng) {
  LogMarksRequest m;
  m.request = 1 + rng.below(1'000'000);
  m.first = 1 + rng.below(1'000'000);
  m.last = m.first + (any64(rng) >> 2);
  m.count = static_cast<std::uint8_t>(1 + rng.below(kLogMarksMax));
  const auto place = [&] { return static_cast<std::int32_t>(rng.below(1 << 20)) - (1 << 19); };
  if (rng.below(2) == 0) m.at = VoxelPos{place(), place(), place()};
  return m;
}

LogMarks any_log_marks(SplitMix64& rng) {
  LogMarks m;
  m.request = 1 + rng.below(1'000'000);
  m.first = 1 + rng.below(1'000'000);
  if (rng.below(8) == 0) {
    m.refusal = any_text(rng, 1, kTextBytesMax);
    return m;
  }
  Sequence seq = m.first;
  for (std::uint32_t left = rng.below(kLogMarksMax + 1); left != 0; --left) {
    m.marks.push_back({seq, any_time(rng), rng.below(1000),
                       static_cast<Cause>(rng.below(kLogMarkCauseMax + 1u)),
                       static_cast<EditKind>(1 + rng.below(255))});
    seq += 1 + rng.below(1000);
  }
  AuthorId author = 0;
  for (std::uint32_t left = rng.below(kLogMarksMax + 1); left != 0; --left) {
    author += 1 + rng.below(1000);
    m.authors.push_back({author, any_name(rng)});
  }
  return m;
}

RestorePreview any_restore_preview(SplitMix64& rng) {
  RestorePreview m;
  m.command = rng.below(1000);
  m.preview = any_text(rng, 0, kPreviewIdBytesMax);
  m.voxels = any64(rng);
  m.chunks = any64(rng);
  m.is_cut = rng.below(2) == 0;
  for (std::uint32_t left = rng.below(8); left != 0; --left) m.edits.push_back(any_edit(rng));
  return m;
}

/// Returns a record of the log at this version. It may change voxels, rights,
/// materials, their shapes or textures, the library or the clock, or stand for a lost record.
EditRecord any_record(SplitMix64& rng, Version version) {
  EditRecord record;
  record.version = version;
  record.op = {rng.below(1000), rng.next(), any64(rng) >> 1};
  record.time_us = any_time(rng);
  record.cause = static_cast<Cause>(rng.below(kCauseMax + 1u));
  if (record.cause == Cause::rights) {
    record.edit = rights_edit(random_rights_change(rng));
  } else if (record.cause == Cause::materials && rng.below(2) == 0) {
    record.edit = shapes_edit(any_given_shapes(rng));
  } else if (record.cause == Cause::materials) {
    MaterialsAdded added = any_materials_added(rng);
    record.edit = materials_edit({added.first, std::move(added.rows)});
  } else if (record.cause == Cause::library) {
    record.edit = library_edit(RemoveBuild{1 + rng.below(1000)});
  } else if (record.cause == Cause::textures) {
    record.edit = texture_edit(any_given_texture(rng));
  } else if (record.cause == Cause::clock) {
    record.edit = clock_edit(any_world_time(rng));
  } else if (record.cause == Cause::gap) {
    record.edit = gap_edit({rng.below(1000), rng.below(2) == 0});
  } else {
    record.edit = any_edit(rng);
  }
  if (rng.below(2) == 0) record.subject = any64(rng) % version.seq;
  if (rng.below(4) == 0) record.log = rng.below(1000);
  return record;
}

LogPart any_log_part(SplitMix64& rng) {
  LogPart m;
  m.epoch = 1 + rng.below(1'000'000);
  m.players.resize(rng.below(5));
  for (LogPlayer& player : m.players) {
    player.author = 1 + rng.below(1000);
    draw(rng, player.key);
    player.name = any_name(rng);
  }
  m.names.resize(rng.below(5));
  for (LogName& name : m.names) {
    name.folded = any_text(rng, 1, rng.below(8) == 0 ? kFoldedNameBytesMax : kPlayerNameBytesMax);
    name.name = any_name(rng);
    draw(rng, name.key);
    name.is_release = rng.below(2) == 0;
  }
  Version version{1 + rng.below(m.epoch), any64(rng) >> 2};
  for (std::uint32_t left = rng.below(5); left != 0; --left) {
    ++version.seq;
    if (rng.below(4) == 0) version.epoch += rng.below(m.epoch - version.epoch + 1);
    m.records.push_back({any_record(rng, version), rng.below(2) == 0 ? 0 : any_time(rng)});
  }
  return m;
}

RelayOpen any_relay_open(SplitMix64& rng) {
  RelayOpen m;
  m.session = static_cast<SessionId>(any64(rng));
  m.address = any64(rng);
  m.is_encrypted = rng.below(2) == 0;
  draw(rng, m.key);
  m.instance = any64(rng);
  m.name = any_name(rng);
  m.features = any64(rng);
  m.author = rng.below(2) == 0 ? 0 : rng.below(1000);
  m.pose = any_pose(rng);
  if (rng.below(2) == 0) m.ticket = any_text(rng, 1, kTicketBytesMax);
  if (rng.below(2) == 0) draw(rng, m.password_key.emplace());
  return m;
}

/// Wraps a message that is small enough for a client's limit, whichever side sends it.
Relay any_relay(SplitMix64& rng) {
  constexpr MessageKind kSmall[] = {
      kKindOf<EditRequest>,  kKindOf<Move>,   kKindOf<CommandRequest>,  kKindOf<ChatRequest>,
      kKindOf<PreviewShare>, kKindOf<Reject>, kKindOf<SessionAccepted>, kKindOf<PlayerPoses>};
  const auto count = static_cast<std::uint32_t>(std::size(kSmall));
  Relay m{{}, encode_message(random_message(rng, kSmall[rng.below(count)]))};
  m.sessions.resize(rng.below(2) == 0 ? 1 : 1 + rng.below(20));
  for (SessionId& session : m.sessions) session = static_cast<SessionId>(any64(rng));
  return m;
}

std::string any_player_address(SplitMix64& rng) {
  const std::string port = ":" + std::to_string(1 + rng.below(65'535));
  if (rng.below(4) == 0) return "[2001:db8::" + std::to_string(rng.below(10'000)) + "]" + port;
  return std::string(1 + rng.below(rng.below(8) == 0 ? 250 : 20), 'a') + "-1.example" + port;
}

std::string any_page_address(SplitMix64& rng) {
  if (rng.below(3) == 0) return "";
  return rng.below(2) == 0 ? "https://play.example/world/a_" + std::to_string(rng.below(1000))
                           : "http://" + any_player_address(rng) + "/";
}

Servers any_servers(SplitMix64& rng) {
  std::set<std::string> addresses;
  for (std::uint32_t left = rng.below(8) == 0 ? kServersMax : rng.below(6); left != 0; --left) {
    std::string address = any_player_address(rng);
    if (address.size() <= kServerAddressBytesMax) addresses.insert(std::move(address));
  }
  Servers m;
  for (const std::string& address : addresses) {
    std::string page = any_page_address(rng);
    if (page.size() > kServerAddressBytesMax) page.clear();
    m.servers.push_back({address, std::move(page), rng.below(100'000)});
  }
  m.here = static_cast<std::uint8_t>(rng.below(static_cast<std::uint32_t>(m.servers.size() + 1)));
  return m;
}

Bytes any_bytes(SplitMix64& rng, std::uint32_t size_max) {
  Bytes bytes(1 + rng.below(rng.below(8) == 0 ? size_max : 40));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.below(256));
  return bytes;
}

Builds any_builds(SplitMix64& rng) {
  Builds m;
  m.request = 1 + rng.below(1000);
  m.total = any64(rng);
  if (rng.below(4) == 0) {
    m.refusal = any_text(rng, 1, kTextBytesMax);
    return m;
  }
  m.has_more = rng.below(2) == 0;
  Sequence number = kSequenceMax;
  for (std::uint32_t left = rng.below(rng.below(8) == 0 ? kListedBuildsMax + 1 : 4); left != 0;
       --left) {
    ListedBuild build;
    build.number = number -= 1 + rng.below(1000);
    build.info.name = "mill " + std::to_string(rng.below(100));
    if (rng.below(2) == 0) build.info.author = "ann";
    if (rng.below(2) == 0) build.info.tags = {"roof", "wood"};
    build.info.created_us = any_time(rng) < 0 ? 0 : 1'700'000'000'000'000;
    build.info.sides = {1 + rng.below(1000), 1 + rng.below(1000), 1 + rng.below(1000)};
    build.info.origin = {rng.between(-999, 999), rng.between(-99, 99), rng.between(-999, 999)};
    build.touched = 1 + any64(rng) % build.info.sides.volume();
    build.file_bytes = 1 + rng.below(1 << 20);
    build.added_by = rng.below(10);
    if (build.added_by != 0) build.added_by_name = any_text(rng, 1, kPlayerNameBytesMax);
    m.builds.push_back(std::move(build));
  }
  return m;
}

BuildPiece any_build_piece(SplitMix64& rng) {
  BuildPiece m;
  m.request = 1 + rng.below(1000);
  if (rng.below(4) == 0) {
    m.refusal = any_text(rng, 1, kTextBytesMax);
  } else {
    m.bytes = any_bytes(rng, kBuildPieceBytes);
  }
  return m;
}

BuildAnswer any_build_answer(SplitMix64& rng) {
  BuildAnswer m{1 + rng.below(1000), rng.below(1 << 30), 0, ""};
  if (rng.below(3) == 0) {
    m.number = 1 + (any64(rng) >> 2);
  } else if (rng.below(2) == 0) {
    m.refusal = any_text(rng, 1, kTextBytesMax);
  }
  return m;
}

FollowRequest any_follow_request(SplitMix64& rng) {
  FollowRequest m{any_version(rng)};
  if (rng.below(2) == 0) m.player_address = "play.example:4747";
  if (rng.below(2) == 0) m.page_address = "https://play.example";
  return m;
}

}  // namespace

std::vector<EditDescriptor> any_preview(SplitMix64& rng) {
  std::vector<EditDescriptor> edits;
  for (std::uint32_t count = rng.below(kPreviewEditsMax + 1); count > 0; --count)
    edits.push_back({SetVoxel{{rng.between(-99, 99), rng.between(-99, 99), rng.between(-99, 99)}},
                     {},
                     static_cast<Material>(rng.below(9))});
  return edits;
}

std::optional<BrushStroke> any_brush_stroke(SplitMix64& rng) {
  if (rng.below(2) == 0) return std::nullopt;
  BrushStroke stroke;
  stroke.size = static_cast<std::uint16_t>(1 + rng.below(32));
  stroke.mode = static_cast<std::uint8_t>(rng.below(7));
  stroke.lowers = rng.below(2) == 0;
  stroke.material = static_cast<Material>(rng.below(9));
  if (rng.below(2) == 0) stroke.mix = "stone, dirt";
  for (std::uint32_t count = 1 + rng.below(9); count > 0; --count)
    stroke.places.push_back({rng.between(-99, 99), rng.between(-99, 99), rng.between(-99, 99)});
  return stroke;
}

PreviewShare any_preview_share(SplitMix64& rng) {
  PreviewShare share{any_preview(rng)};
  if (!share.edits.empty()) share.stroke = any_brush_stroke(rng);
  return share;
}

EditRequest any_edit_request(SplitMix64& rng) {
  EditRequest request{1 + (any64(rng) >> 1), any_time(rng), {}};
  if (rng.below(8) == 0) {
    request.fault = Error{ErrorCode::truncated, "no descriptor", 0};
  } else {
    request.edit = any_edit(rng);
  }
  if (rng.below(2) == 0) request.action = 1 + any64(rng) % request.client_seq;
  request.is_optional = request.action != 0 && rng.below(2) == 0;
  return request;
}

Message random_message(SplitMix64& rng, MessageKind kind) {
  switch (kind) {
    case kKindOf<Hello>:
      return any_hello(rng);
    case kKindOf<Welcome>:
      return any_welcome(rng);
    case kKindOf<ClientAuth>:
      return any_client_auth(rng);
    case kKindOf<SessionAccepted>:
      return SessionAccepted{static_cast<AuthorId>(any64(rng) >> 32), any64(rng),
                             rng.below(2) == 0 ? 0 : rng.below(1000),
                             rng.below(2) == 0 ? std::nullopt : std::optional(any_pose(rng))};
    case kKindOf<View>:
      return any_view(rng);
    case kKindOf<ChunkRequest>:
      return any_chunk_request(rng);
    case kKindOf<Chunks>:
      return any_chunks(rng);
    case kKindOf<EditRequest>:
      return any_edit_request(rng);
    case kKindOf<Commit>:
      return any_commit(rng);
    case kKindOf<VeiledCommit>:
      return any_veiled_commit(rng);
    case kKindOf<VeilPatches>:
      return any_veil_patches(rng);
    case kKindOf<Reject>:
      return any_reject(rng);
    case kKindOf<Durable>:
      return Durable{1 + rng.below(1000), any64(rng), rng.below(2) == 0};
    case kKindOf<DigestCheck>:
      return any_digest_check(rng);
    case kKindOf<Move>:
      return Move{any_pose(rng)};
    case kKindOf<PlayerPoses>:
      return any_poses(rng);
    case kKindOf<PlayerList>:
      return any_player_list(rng);
    case kKindOf<Ping>:
      return Ping{any_time(rng)};
    case kKindOf<Pong>:
      return Pong{any_time(rng), any_time(rng)};
    case kKindOf<Goodbye>:
      return Goodbye{static_cast<GoodbyeReason>(1 + rng.below(kGoodbyeReasonMax)),
                     any_text(rng, 0, kTextBytesMax)};
    case kKindOf<ChunkUnavailable>:
      return any_unavailable(rng);
    case kKindOf<HistoryRequest>:
      return any_history_request(rng);
    case kKindOf<ViewState>:
      return any_view_state(rng);
    case kKindOf<CommandRequest>:
      return CommandRequest{rng.below(1000), any_text(rng, 1, kCommandBytesMax)};
    case kKindOf<CommandOutput>:
      return any_output(rng);
    case kKindOf<ReceiveAck>:
      return ReceiveAck{1 + (any64(rng) >> 1)};
    case kKindOf<UniformChunks>:
      return any_uniform(rng);
    case kKindOf<CachedChunks>:
      return any_cached_chunks(rng);
    case kKindOf<ChunksNotModified>:
      return any_chunks_not_modified(rng);
    case kKindOf<Permissions>:
      return any_permissions(rng);
    case kKindOf<ProtectedGround>:
      return any_ground(rng);
    case kKindOf<ChatRequest>:
      return ChatRequest{any_text(rng, 1, kChatBytesMax)};
    case kKindOf<ChatWithdrawn>:
      return any_chat_withdrawn(rng);
    case kKindOf<ChatLines>:
      return any_chat_lines(rng);
    case kKindOf<KeyRequest>:
      return KeyRequest{any_slot(rng)};
    case kKindOf<SealedKey>:
      return SealedKey{any_sealed(rng)};
    case kKindOf<KeyDeposit>: {
      KeyDeposit m{any_slot(rng), any_sealed(rng)};
      draw(rng, m.signature);
      return m;
    }
    case kKindOf<KeyDeposited>:
      return KeyDeposited{rng.below(1000), any_text(rng, 0, kTextBytesMax)};
    case kKindOf<MaterialsAdded>:
      return any_materials_added(rng);
    case kKindOf<ShapesGiven>:
      return ShapesGiven{any_given_shapes(rng)};
    case kKindOf<TexturesGiven>:
      return any_textures_given(rng);
    case kKindOf<TexturesWanted>:
      return any_textures_wanted(rng);
    case kKindOf<TextureParts>:
      return any_texture_parts(rng);
    case kKindOf<WorldTime>:
      return any_world_time(rng);
    case kKindOf<LogMarksRequest>:
      return any_log_marks_request(rng);
    case kKindOf<LogMarks>:
      return any_log_marks(rng);
    case kKindOf<RestorePreview>:
      return any_restore_preview(rng);
    case kKindOf<PreviewShare>:
      return any_preview_share(rng);
    case kKindOf<PlayerPreview>: {
      PreviewShare share = any_preview_share(rng);
      return PlayerPreview{rng.below(1000), std::move(share.edits), std::move(share.stroke)};
    }
    case kKindOf<FollowRequest>:
      return any_follow_request(rng);
    case kKindOf<FollowAnswer>:
      return FollowAnswer{any64(rng) >> 1};
    case kKindOf<LogPart>:
      return any_log_part(rng);
    case kKindOf<RelayOpen>:
      return any_relay_open(rng);
    case kKindOf<Relay>:
      return any_relay(rng);
    case kKindOf<RelayClose>:
      return RelayClose{static_cast<SessionId>(any64(rng)),
                        static_cast<std::uint8_t>(1 + rng.below(kGoodbyeReasonMax)),
                        any_text(rng, 0, kTextBytesMax)};
    case kKindOf<RelayCharge>:
      return RelayCharge{static_cast<SessionId>(any64(rng)), any64(rng)};
    case kKindOf<Resume>:
      return Resume{any64(rng) >> 1};
    case kKindOf<Resumed>:
      return Resumed{};
    case kKindOf<Servers>:
      return any_servers(rng);
    case kKindOf<BuildsRequest>:
      return BuildsRequest{1 + rng.below(1000),
                           any_text(rng, 0, kBuildNameBytesMax),
                           any_text(rng, 0, kBuildAuthorBytesMax),
                           any_text(rng, 0, kBuildTagBytesMax),
                           1 + (any64(rng) >> 2),
                           static_cast<std::uint8_t>(1 + rng.below(kListedBuildsMax))};
    case kKindOf<Builds>:
      return any_builds(rng);
    case kKindOf<BuildPieceRequest>:
      return BuildPieceRequest{1 + rng.below(1000), 1 + (any64(rng) >> 2),
                               std::uint64_t{rng.below(1 << 14)} * kBuildPieceBytes};
    case kKindOf<BuildPiece>:
      return any_build_piece(rng);
    case kKindOf<BuildOffer>:
      return BuildOffer{1 + rng.below(1000), 1 + rng.below(1 << 30)};
    case kKindOf<BuildUpload>:
      return BuildUpload{1 + rng.below(1000), rng.below(1 << 30),
                         any_bytes(rng, kBuildUploadBytesMax)};
    default:
      RUNSTONE_ASSERT(kind == kKindOf<BuildAnswer>);
      return any_build_answer(rng);
  }
}

Sender sender_of(MessageKind kind) {
  return may_send(info_of(kind), Sender::client) ? Sender::client : Sender::server;
}

Result<Message> decode(const EncodedMessage& encoded) {
  return decode_message(sender_of(encoded.kind), encoded.kind, *encoded.bytes, kMessageEdge);
}

}  // namespace runstone::test
