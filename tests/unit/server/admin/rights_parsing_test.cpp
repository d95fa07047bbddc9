// The commands about roles, restrictions, ground and the password, as values.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/admin/edit_budget_text.hpp"
#include "server/admin/ground_commands.hpp"
#include "server/admin/moderation_commands.hpp"
#include "server/admin/password_commands.hpp"
#include "server/admin/player_commands.hpp"
#include "server/admin/role_commands.hpp"
#include "tests/unit/server/admin/parsed_command.hpp"

namespace runstone::test {
namespace {

constexpr const char* kPlayer = "a name, # and a number, a key or a fingerprint";
constexpr const char* kName = "a name of a-z, 0-9, \"_\", \"-\" and \".\", at most 32 characters";
constexpr const char* kRights =
    "see, build, build_protected, claim, protect, look_back, undo, roll_back, chat, moderate, "
    "grant, administer";

}  // namespace

TEST_CASE("commands about roles and grants are parsed", "[admin][rights]") {
  CHECK(row_of("roles") == "roles");
  const Role mason =
      parsed<Role>("role set mason build,see,undo volume 1000 claims 3 claim-volume 4096");
  CHECK(mason == Role{"mason", {Right::see, Right::build, Right::undo}, 1000, 3, 4096});
  const Role slow = parsed<Role>("role set slow see edits 25/900 view 6 loads 100");
  CHECK(slow.edit_budget == Budget{25, 900});
  CHECK(slow.view_radius_max == 6);
  CHECK(slow.chunk_loads_per_second == 100);
  CHECK(parsed<Role>("role set slow see edits large").edit_budget == Budget{1'000, 40'000});
  CHECK(parsed<Role>("role set nobody none") == Role{"nobody", {}, 0, 0, 0});
  CHECK(row_of("role remove mason") == "role remove");
  CHECK(parsed<std::string>("role remove mason") == "mason");
  CHECK(row_of("role default mason") == "role default");
  CHECK(parsed<std::string>("role default mason") == "mason");
  CHECK(parsed<GrantCommand>("grant \"the mole\" mason") == GrantCommand{"the mole", "mason"});
  CHECK(parsed<GrantCommand>("grant ana mason for 2h") ==
        GrantCommand{"ana", "mason", kTypedUs + 7'200'000'000});
  CHECK(row_of("revoke #3") == "revoke");
  CHECK(parsed<std::string>("revoke #3") == "#3");
  CHECK(row_of("grants") == "grants");
}

TEST_CASE("commands about restrictions are parsed", "[admin][rights]") {
  const auto ban = parsed<RestrictCommand>("ban ana for 2d reason \"broke the bridge\"");
  CHECK(ban.kind == RestrictionKind::ban);
  CHECK(ban.who == std::vector{RestrictionWord{"ana", std::nullopt, false}});
  CHECK(ban.until_us == kTypedUs + 2 * 86'400'000'000);
  CHECK(ban.reason == "broke the bridge");
  const auto mute = parsed<RestrictCommand>("mute ana");
  CHECK(mute == RestrictCommand{RestrictionKind::mute, {{"ana", std::nullopt, false}}, 0, ""});
  CHECK(parsed<RestrictCommand>("freeze #3 reason x").kind == RestrictionKind::freeze);

  const auto range = parsed<RestrictCommand>("ban 192.0.2.7/24").who.at(0);
  CHECK(range.player.empty());
  CHECK(range.range == AddressRange{address_block_v4(0xc0'00'02'00), 32 + 24});
  CHECK(range.address == "192.0.2.7/24");
  CHECK_FALSE(range.is_address);
  CHECK(parsed<RestrictCommand>("ban address 192.0.2.7").who.at(0).is_address);
  CHECK(parsed<RestrictCommand>("ban address for 1h").who.at(0).player == "address");
  CHECK(parsed<RestrictCommand>("ban address").who.at(0).player == "address");
  const auto wide = parsed<RestrictCommand>("ban 2001:db8::1").who.at(0);
  CHECK(wide.is_widened);
  CHECK(wide.range == AddressRange{AddressBlock{0x2001'0db8'0000'0000}, 64});

  CHECK(parsed<LiftCommand>("unban ana").kind == RestrictionKind::ban);
  CHECK(parsed<LiftCommand>("unmute ana").kind == RestrictionKind::mute);
  CHECK(parsed<LiftCommand>("unfreeze ana").kind == RestrictionKind::freeze);
  CHECK(row_of("bans") == "bans");
  CHECK(parsed<KickCommand>("kick ana reason \"come back\"") == KickCommand{{"ana"}, "come back"});
  CHECK(parsed<KickCommand>("kick ana").reason.empty());
}

TEST_CASE("commands about restrictions take several players", "[admin][rights]") {
  const auto ban = parsed<RestrictCommand>(
      "ban ana \"the mole, jr.\" address 192.0.2.7 #3 2001:db8::1 for 1h reason x");
  REQUIRE(ban.who.size() == 5);
  CHECK(ban.who[0].player == "ana");
  CHECK(ban.who[1].player == "the mole, jr.");
  CHECK(ban.who[2].is_address);
  CHECK(ban.who[3].player == "#3");
  CHECK(ban.who[4].is_widened);
  CHECK(ban.until_us == kTypedUs + 3'600'000'000);
  CHECK(ban.reason == "x");
  CHECK(parsed<LiftCommand>("unmute ana bob").who.size() == 2);
  CHECK(parsed<KickCommand>("kick 2d ana reason x") == KickCommand{{"2d", "ana"}, "x"});
}

TEST_CASE("commands about protected ground are parsed", "[admin][rights]") {
  const auto town = parsed<ProtectCommand>("protect town 5 60 -3 -4 70 8 owner ana priority -2");
  CHECK(town.name == "town");
  CHECK(town.box == VoxelBox{{-4, 60, -3}, {6, 71, 9}});  // both corners inside
  CHECK(town.owner == "ana");
  CHECK(town.priority == -2);
  const auto strip = parsed<ProtectCommand>("protect strip columns 9 1 -2 3");
  CHECK(strip.box == columns(-2, 1, 10, 4));
  const auto later = parsed<ProtectCommand>("protect town priority 7");
  CHECK_FALSE(later.box.has_value());
  CHECK(later.priority == 7);

  const auto add = parsed<BoxMembersCommand>("protect town add ana role:mason #3");
  CHECK(add == BoxMembersCommand{"town", false, {"ana", "#3"}, {"mason"}});
  CHECK(parsed<BoxMembersCommand>("protect town remove ana").is_removal);
  CHECK(parsed<ClaimCommand>("claim home 0 0 0 1 1 1").box == VoxelBox{{0, 0, 0}, {2, 2, 2}});
  CHECK(parsed<ClaimCommand>("claim home columns 0 0 1 1").box == columns(0, 0, 2, 2));
  CHECK(row_of("unprotect town") == "unprotect");
  CHECK(parsed<std::string>("unprotect town") == "town");
  CHECK_FALSE(parsed<std::optional<VoxelPos>>("protected").has_value());
  CHECK(parsed<std::optional<VoxelPos>>("protected at 1 -2 3") == VoxelPos{1, -2, 3});
}

TEST_CASE("questions and the way back are parsed", "[admin][rights]") {
  CHECK(parsed<WhyCommand>("why ana chat") == WhyCommand{"ana", Right::chat, std::nullopt});
  CHECK(parsed<WhyCommand>("why ana build 1 2 3") ==
        WhyCommand{"ana", Right::build, VoxelPos{1, 2, 3}});
  CHECK(row_of("rights undo 9120") == "rights");
  CHECK(parsed<Sequence>("rights undo 9120") == 9120);
}

TEST_CASE("commands about invites are parsed", "[admin][rights]") {
  constexpr TimeUs kDay = 86'400'000'000;
  CHECK(parsed<CreateInviteCommand>("invite") ==
        CreateInviteCommand{"builder", 1, kTypedUs + 7 * kDay});
  const CreateInviteCommand five{"visitor", 5, kTypedUs + 3 * kDay};
  CHECK(parsed<CreateInviteCommand>("invite --uses 5 --days 3 --role visitor") == five);
  CHECK(parsed<CreateInviteCommand>("invite role visitor uses 5 for 72h") == five);
  CHECK(row_of("invite cancel 00000000000000ff") == "invite cancel");
  CHECK(parsed<InviteId>("invite cancel 00000000000000ff") == 255);
  CHECK(row_of("invites") == "invites");
  CHECK(row_of("refusals") == "refusals");
  CHECK(mistake("invite uses 0").find("uses \"0\"") != std::string::npos);
  CHECK(mistake("invite 5").find("invite \"5\": role ROLE") != std::string::npos);
  CHECK(mistake("invite cancel x") == "invite cancel \"x\": an id (invites lists them)");
  CHECK(mistake("invites 3").find("nothing comes after invites") != std::string::npos);
}

TEST_CASE("commands about the password are parsed", "[admin][rights]") {
  CHECK(row_of("password") == "password");
  CHECK(row_of("password clear") == "password clear");
  CHECK(parsed<SetPasswordCommand>("password set") ==
        SetPasswordCommand{{"builder", {}, {}}, false});
  JoinPassword password{"visitor", {1, 2}, {3, 4}};
  password.hash.back() = 0xff;
  CHECK(parsed<SetPasswordCommand>("password set role visitor verifier " +
                                   verifier_text(password)) == SetPasswordCommand{password, true});
  CHECK(mistake("password get") == "password: set or clear comes after it");
  CHECK(mistake("password clear it") == "password clear \"it\": nothing comes after it");
  // The word may be the password itself.
  CHECK(mistake("password set hunter2").find("hunter2") == std::string::npos);
  CHECK(mistake("password set verifier") ==
        "password set verifier: 96 hexadecimal digits is missing");
  for (const std::string& wrong :
       {std::string(94, 'a'), std::string(98, 'a'), std::string(96, 'g'), std::string("ab")})
    CHECK(mistake("password set verifier " + wrong) ==
          "password set verifier: 96 hexadecimal digits");
}

TEST_CASE("an error in a command about roles names the wrong word", "[admin][rights]") {
  CHECK(mistake("roles all") == "roles \"all\": nothing comes after roles");
  CHECK(mistake("role") == "role: set, remove or default is missing");
  CHECK(mistake("role make mason") == "role \"make\": set, remove or default");
  CHECK(mistake("role set Mason see") == std::string("role set \"Mason\": ") + kName);
  CHECK(mistake("role set mason") ==
        "role set mason: rights, separated by commas without blanks, or none, is missing");
  CHECK(mistake("role set mason see,fly") ==
        std::string("role set mason \"fly\": none, or any of ") + kRights);
  CHECK(mistake("role set mason see,") ==
        std::string("role set mason \"\": none, or any of ") + kRights);
  CHECK(mistake("role set mason see limit 3") ==
        "role set \"limit\": volume, claims, claim-volume, edits, view or loads");
  CHECK(mistake("role set mason see edits unlimited") ==
        "edits \"unlimited\": " + edit_budget_rule() + "; not unlimited");
  CHECK(mistake("role set mason see edits 5") ==
        "edits \"5\": " + edit_budget_rule() + "; not unlimited");
  CHECK(mistake("role set mason see view 256") == "view \"256\": a number from 0 to 255");
  CHECK(mistake("role set mason see loads -1") == "loads \"-1\": a number from 0 to 1000000");
  CHECK(mistake("role set mason see claims -1") == "claims \"-1\": a number from 0 to 4294967295");
  CHECK(mistake("role remove mason now") == "role remove mason \"now\": nothing comes after it");
  CHECK(mistake("role default") == std::string("role default: ") + kName + " is missing");
  CHECK(mistake("grant") == std::string("grant: ") + kPlayer + " is missing");
  CHECK(mistake("grant #x mason") == "grant \"#x\": a number comes after #");
  CHECK(mistake("grant ana") == std::string("grant ana: ") + kName + " is missing");
  CHECK(mistake("grant ana mason 1") == "grant ana mason \"1\": nothing comes after it");
  CHECK(mistake("revoke ana mason") == "revoke ana \"mason\": nothing comes after it");
  CHECK(mistake("grants ana") == "grants \"ana\": nothing comes after grants");
}

TEST_CASE("an error in a command about restrictions names the wrong word", "[admin][rights]") {
  CHECK(mistake("ban") == "ban: a player, an address or a range is missing");
  CHECK(mistake("ban ana 2d") == "ban \"2d\": for DURATION or reason \"TEXT\"");
  CHECK(mistake("ban ana for ever") == "for \"ever\": how long (90s, 15m, 2h30m, 2d, 1w)");
  CHECK(mistake("ban ana for 0s") == "for \"0s\": how long (90s, 15m, 2h30m, 2d, 1w)");
  CHECK(mistake("ban ana reason") == "reason: a text, in quotes if it has blanks, is missing");
  CHECK(mistake("ban ana reason " + std::string(201, 'a')) == "reason: at most 200 bytes, not 201");
  CHECK(mistake("ban 192.0.2.0/33") ==
        "ban \"192.0.2.0/33\": a number from 0 to 32 comes after the / of IPv4");
  CHECK(mistake("ban 2001:db8::/128") ==
        "ban \"2001:db8::/128\": a number from 0 to 64 comes after the / of IPv6: a subscriber "
        "has at least a /64");
  CHECK(mistake("mute 192.0.2.7") == "mute \"192.0.2.7\": only bans are for addresses");
  CHECK(mistake("mute") == std::string("mute: ") + kPlayer + " is missing");
  CHECK(mistake("unban ana for 2d") == "unban \"for\": nothing comes after it");
  CHECK(mistake("bans ana") == "bans \"ana\": nothing comes after bans");
  CHECK(mistake("kick") == std::string("kick: ") + kPlayer + " is missing");
  CHECK(mistake("kick ana 2d") == "kick \"2d\": reason \"TEXT\"");
  CHECK(mistake("ban ana for 1h bob") == "ban \"bob\": for DURATION or reason \"TEXT\"");
  CHECK(mistake("mute ana 192.0.2.7") == "mute \"192.0.2.7\": only bans are for addresses");
}

TEST_CASE("an error in a command about ground names the wrong word", "[admin][rights]") {
  const std::string six = "six numbers: x y z of one corner and of the opposite one, both inside";
  CHECK(mistake("protect") == std::string("protect: ") + kName + " is missing");
  CHECK(mistake("protect town") ==
        "protect town: X Y Z X Y Z, columns X Z X Z, owner, priority, add or remove is missing");
  CHECK(mistake("protect town all") ==
        "protect town \"all\": X Y Z X Y Z, columns X Z X Z, owner, priority, add or remove");
  CHECK(mistake("protect town 1 2 3 4 5") == "protect town: " + six + " is missing");
  CHECK(mistake("protect town 1 2 3 4 5 6 7") == "protect town \"7\": owner or priority");
  CHECK(mistake("protect town 1 2 3 4 5 far") ==
        "protect town \"far\": a whole number from -536870912 to 536870911");
  CHECK(mistake("protect town columns 1 2 3") ==
        "columns: four numbers: x z of one corner and of the opposite one, both inside is missing");
  CHECK(mistake("protect town priority 1001") == "priority \"1001\": a number from -1000 to 1000");
  CHECK(mistake("protect town owner") == std::string("owner: ") + kPlayer + " is missing");
  CHECK(mistake("protect town add") == "protect town add: a player or role:ROLE is missing");
  CHECK(mistake("protect town add role:") ==
        "protect town add \"role:\": the name of a role comes after role:");
  CHECK(mistake("claim home") == "claim home: " + six + " is missing");
  CHECK(mistake("claim home 0 0 0 1 1 1 1") == "claim home \"1\": nothing comes after it");
  CHECK(mistake("unprotect") == std::string("unprotect: ") + kName + " is missing");
  CHECK(mistake("protected 1 2 3") == "protected \"1\": at X Y Z");
  CHECK(mistake("protected at 1 2") == "at: three numbers: x y z of a voxel is missing");
}

TEST_CASE("an error in a question about rights names the wrong word", "[admin][rights]") {
  CHECK(mistake("why") == std::string("why: ") + kPlayer + " is missing");
  CHECK(mistake("why ana") == std::string("why: one of the rights ") + kRights + " is missing");
  CHECK(mistake("why ana fly") == std::string("why \"fly\": one of the rights ") + kRights);
  CHECK(mistake("why ana chat 1 2 3") == "why \"1\": a place comes after the right build only");
  CHECK(mistake("why ana build 1 2") == "why: three numbers: x y z of a voxel is missing");
  CHECK(mistake("rights") == "rights: undo SEQ is missing");
  CHECK(mistake("rights back 3") == "rights \"back\": undo SEQ");
  CHECK(mistake("rights undo 0") == "rights undo \"0\": a number from 1 to 9223372036854775807");
}

}  // namespace runstone::test
