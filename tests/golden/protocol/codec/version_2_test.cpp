#include <catch2/catch.hpp>
#include <string>
#include <string_view>

#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/rights/right.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/codec/chat_messages.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/limits.hpp"

// What version 2 of the protocol has beside the schema: who sends a kind, in which class and stage,
// and the numbers of features, enumerations and frames. Nothing here ever changes. What a later
// version adds is pinned beside it, in a file of that version.
namespace runstone::test {
namespace {

// number, name, sender, class, stage and bit of the feature
constexpr const char* kKindsOfVersion2[] = {
    "1 Hello client control greeting -",
    "2 Welcome server control greeting -",
    "3 ClientAuth client control authenticating -",
    "4 SessionAccepted server edits authenticating -",
    "5 View client control open -",
    "6 ChunkRequest client control open -",
    "7 Chunks server chunks open -",
    "8 EditRequest client edits open -",
    "9 Commit server edits open -",
    "10 Reject server edits open -",
    "11 Durable server edits open -",
    "12 DigestCheck server control open -",
    "13 Move client control open -",
    "14 PlayerPoses server control open -",
    "15 PlayerList server control open -",
    "16 Ping client control open -",
    "17 Pong server control open -",
    "18 Goodbye both control any -",
    "19 ChunkUnavailable server chunks open -",
    "20 HistoryRequest client control open -",
    "21 ViewState server chunks open -",
    "22 CommandRequest client control open 0",
    "23 CommandOutput server control open 0",
    "24 ReceiveAck client control open 1",
    "25 UniformChunks server chunks open -",
    "26 CachedChunks client control open -",
    "27 ChunksNotModified server chunks open -",
    "28 Permissions server control open 3",
    "29 ProtectedGround server control open 3",
    "30 ChatRequest client control open 4",
    "31 ChatLines server control open 4",
    "32 KeyRequest client control authenticating 5",
    "33 SealedKey server control authenticating 5",
    "34 KeyDeposit client control authenticating 5",
    "35 KeyDeposited server control authenticating 5",
    "36 MaterialsAdded server edits open 6",
    "37 LogMarksRequest client control open 7",
    "38 LogMarks server control open 7",
    "39 RestorePreview server control open 8",
    "40 PreviewShare client control open 9",
    "41 PlayerPreview server control open 9",
    "42 FollowRequest client edits open 11",
    "43 FollowAnswer server edits open 11",
    "44 LogPart server edits open 11",
    "45 RelayOpen client edits open 11",
    "46 Relay both edits open 11",
    "47 RelayClose both edits open 11",
    "48 RelayCharge server control open 11",
    "49 Resume server edits open 12",
    "50 Resumed client edits open 12",
    "51 Servers server edits open 13",
};

/// Returns the row of a kind as kKindsOfVersion2 writes it.
std::string row_of(MessageKind kind) {
  const MessageInfo& info = info_of(kind);
  constexpr const char* kSenders[] = {"client", "server", "both"};
  constexpr const char* kClasses[] = {"control", "edits", "chunks"};
  constexpr const char* kStages[] = {"greeting", "authenticating", "open"};
  int bit = 0;
  while (info.feature != 0 && info.feature >> bit != 1) ++bit;
  return std::to_string(wire_number(kind)) + " " + info.name + " " +
         kSenders[static_cast<int>(info.sent_by)] + " " +
         kClasses[static_cast<int>(info.frame_class)] + " " +
         (info.stage ? kStages[static_cast<int>(*info.stage)] : "any") + " " +
         (info.feature == 0 ? "-" : std::to_string(bit));
}

/// Checks that the values are first, first + 1 and so on.
template <class Enum>
void check_values(int first, std::initializer_list<Enum> values) {
  for (const Enum value : values) CHECK(static_cast<int>(value) == first++);
}

}  // namespace

TEST_CASE("the kinds of messages of version 2 keep their rows", "[protocol][golden]") {
  MessageKind kind = 0;
  for (const char* const row : kKindsOfVersion2) CHECK(row_of(kind++) == row);
}

TEST_CASE("the numbers of version 2 keep their meaning", "[protocol][golden]") {
  using R = RejectReason;
  check_values(1, {R::busy, R::already_resolved, R::unknown_material, R::too_large, R::out_of_reach,
                   R::not_permitted, R::rate_limited, R::bad_edit, R::outside_world});
  using G = GoodbyeReason;
  check_values(1,
               {G::closing, G::wrong_protocol, G::malformed_frame, G::malformed_message,
                G::unexpected_message, G::not_authenticated, G::already_connected, G::server_full,
                G::timed_out, G::flooding, G::internal, G::name_refused, G::not_admitted});
  check_values(1, {UnavailableReason::damaged});
  check_values(0, {HistoryTarget::live, HistoryTarget::sequence, HistoryTarget::time});
  check_values(1, {ViewPhase::begins, ViewPhase::complete, ViewPhase::refused});
  using L = ChatLineKind;
  check_values(1, {L::player, L::server, L::message_of_the_day, L::refused});
  check_values(1, {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded});
}

TEST_CASE("the numbers that version 2 shares with the log of world format 5 keep their meaning",
          "[edits][golden]") {
  using E = EditKind;
  check_values(1, {E::set_voxel, E::fill_box, E::fill_sphere, E::fill_stroke});
  check_values(6, {E::paste, E::rights, E::materials, E::materials_with_looks});
  using M = MaskKind;
  check_values(0, {M::everything, M::only_empty, M::only_solid, M::only_material});
  using C = Cause;
  check_values(0, {C::player, C::console, C::rollback, C::undo, C::redo, C::import, C::rights,
                   C::materials});
  using R = Right;
  check_values(0, {R::see, R::build, R::build_protected, R::claim, R::protect, R::look_back,
                   R::undo, R::roll_back, R::chat, R::moderate, R::grant, R::administer});
  check_values(0, {Visibility::empty, Visibility::opaque, Visibility::transparent});
  check_values(0, {MaterialBody::solid, MaterialBody::liquid, MaterialBody::passable});
  using P = MaterialPattern;
  check_values(0, {P::none, P::planks, P::bricks, P::tiles, P::cobble, P::bark, P::weave});
}

TEST_CASE("the features and frames of version 2 keep their numbers", "[protocol][golden]") {
  CHECK(kFeatureCommands == 1);
  CHECK(kFeatureReceiveAck == 1 << 1);
  CHECK(kFeatureNames == 1 << 2);
  CHECK(kFeatureRights == 1 << 3);
  CHECK(kFeatureChat == 1 << 4);
  CHECK(kFeatureKeyTransfer == 1 << 5);
  CHECK(kFeatureMaterials == 1 << 6);
  CHECK(kFeatureLogMarks == 1 << 7);
  CHECK(kFeatureRestorePreview == 1 << 8);
  CHECK(kFeaturePreviews == 1 << 9);
  CHECK(kFeatureTiles == 1 << 10);
  CHECK(kFeatureServers == 1 << 11);
  CHECK(kFeatureResume == 1 << 12);
  CHECK(kFeatureServerList == 1 << 13);
  CHECK(kFrameHeaderBytes == 8);
  CHECK(kFragmentBytesMax == 16'384);
  CHECK(kClientControlBytesMax == 4'096);
  CHECK(kClientEditBytesMax == 65'536);
  CHECK(kServerControlBytesMax == 8'388'608);
  CHECK(kServerEditBytesMax == 1'048'576);
  CHECK(kServerChunkBytesMax == 16'777'216);
}

}  // namespace runstone::test
