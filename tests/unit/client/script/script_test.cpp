#include "client/script/script.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

Script parse(std::string_view text) {
  auto script = parse_script(text, "s.txt");
  INFO((script ? "" : script.error().message()));
  REQUIRE(script.has_value());
  return *script;
}

std::string message_of(std::string_view text) {
  const auto script = parse_script(text, "s.txt");
  return script ? "accepted" : script.error().message();
}

template <class T>
T only(std::string_view line) {
  const Script script = parse(line);
  REQUIRE(script.commands.size() == 1);
  REQUIRE(std::holds_alternative<T>(script.commands[0].step));
  return std::get<T>(script.commands[0].step);
}

}  // namespace

TEST_CASE("every command is parsed with its values", "[bots]") {
  using Base = ScriptCoordinate::Base;
  const auto move = only<script::Move>("move 1 ~-2.5 ~");
  CHECK(move.to[0].base == Base::world);
  CHECK(move.to[0].offset == 1);
  CHECK(move.to[1].base == Base::player);
  CHECK(move.to[1].offset == -2.5);
  CHECK(move.to[2].base == Base::player);
  CHECK(move.to[2].offset == 0);
  CHECK(only<script::Move>("move 1 ^+1 2").to[1].base == Base::surface);
  CHECK(only<script::Walk>("walk 1 2 3 4.5").speed == 4.5);
  CHECK(only<script::Roam>("roam ~64 ~ ~ 320").speed == 320);
  CHECK(only<script::Look>("look 90 -30").pitch == -30);
  CHECK(only<script::LookAt>("lookat 1 2 3").at[2].offset == 3);
  CHECK(only<script::Set>("set 1 2 3 stone").material == "stone");
  CHECK(only<script::Set>("remove 1 2 3").material == "0");
  const auto box = only<script::Box>("box 1 2 3 4 5 6 grass only:stone");
  CHECK(box.to[0].offset == 4);
  CHECK(box.material == "grass");
  CHECK(box.mask.kind == MaskKind::only_material);
  CHECK(box.mask.material == "stone");
  CHECK(only<script::Box>("box 1 2 3 4 5 6 grass").mask.kind == MaskKind::everything);
  const auto sphere = only<script::Sphere>("sphere 1 2 3 50 0 solid");
  CHECK(sphere.radius == 50);
  CHECK(sphere.mask.kind == MaskKind::only_solid);
  const auto stroke = only<script::Stroke>("stroke 2 stone 1 2 3 ~ ^+1 ~5 7 8 9 only:sand");
  CHECK(stroke.radius == 2);
  CHECK(stroke.material == "stone");
  REQUIRE(stroke.points.size() == 3);
  CHECK(stroke.points[1][1].base == Base::surface);
  CHECK(stroke.points[2][2].offset == 9);
  CHECK(stroke.mask.material == "sand");
  CHECK(only<script::Stroke>("stroke 1 0 1 2 3 4 5 6").mask.kind == MaskKind::everything);
  const auto copy = only<script::Copy>("copy house 1 2 3 ~4 ^ 6 solid");
  CHECK(copy.name == "house");
  CHECK(copy.solid);
  CHECK(copy.to[1].base == Base::surface);
  CHECK_FALSE(only<script::Copy>("copy house 1 2 3 4 5 6").solid);
  const auto paste = only<script::Paste>("paste house 1 2 ~ rotate 3 mirror y solid");
  CHECK(paste.name == "house");
  CHECK(paste.orientation == Orientation{}.rotated_about_y(3).mirrored(Axis::y));
  CHECK(paste.mask.kind == MaskKind::only_solid);
  CHECK(only<script::Paste>("paste house 1 2 3").orientation == Orientation{});
  only<script::Dig>("dig");
  CHECK(only<script::Place>("place sand").material == "sand");
  CHECK(only<script::Wait>("wait 0.25").seconds == 0.25);
  CHECK(only<script::WaitUntil>("wait loaded").seconds_max == kScriptWaitSecondsMax);
  CHECK(only<script::WaitUntil>("wait durable 5").seconds_max == 5);
  CHECK(only<script::WaitUntil>("wait synced").what == script::Until::synced);
  CHECK(only<script::Screenshot>("screenshot a.png").file == "a.png");
  CHECK(only<script::Expect>("expect 1 2 3 air").material == "air");
  const auto burst = only<script::Burst>("burst 100 50 8 18446744073709551615 stone");
  CHECK(burst.count == 100);
  CHECK(burst.rate == 50);
  CHECK(burst.radius == 8);
  CHECK(burst.seed == UINT64_MAX);
  CHECK(only<script::Digests>("digests d.json").file == "d.json");
  only<script::Quit>("quit");
}

TEST_CASE("empty lines, comments and blanks have no effect", "[bots]") {
  const Script script = parse("\n  # a comment\n\tdig   # and one behind\r\n\n quit");
  REQUIRE(script.commands.size() == 2);
  CHECK(script.commands[0].line == 3);
  CHECK(script.commands[1].line == 5);
  CHECK(parse("").commands.empty());
}

TEST_CASE("a repeat and its end have each other's index", "[bots]") {
  const Script script = parse("repeat 2\n repeat 3\n dig\n end\nend\nquit");
  CHECK(std::get<script::Repeat>(script.commands[0].step).end == 4);
  CHECK(std::get<script::Repeat>(script.commands[1].step).end == 3);
  CHECK(std::get<script::End>(script.commands[3].step).repeat == 1);
  CHECK(std::get<script::End>(script.commands[4].step).repeat == 0);
}

TEST_CASE("an error names file, line and mistake", "[bots]") {
  CHECK(message_of("dig\nfly 1 2 3") == "s.txt:2: unknown command \"fly\"");
  CHECK(message_of("move 1 2") == "s.txt:1: expected Z");
  CHECK(message_of("move 1 2 x") == "s.txt:1: Z: \"x\" is not a coordinate");
  CHECK(message_of("move ^ 2 3") == "s.txt:1: ^ is for y only");
  CHECK(message_of("move 1 2 3 4") == "s.txt:1: unexpected \"4\"");
  CHECK(message_of("move 1e300 2 3") == "s.txt:1: X: \"1e300\" is not a coordinate");
  CHECK(message_of("move nan 2 3") == "s.txt:1: X: \"nan\" is not a coordinate");
  CHECK(message_of("set 1 2 3") == "s.txt:1: expected MATERIAL");
  CHECK(message_of("sphere 1 2 3 513 stone") == "s.txt:1: R: \"513\" is not a number in its range");
  CHECK(message_of("sphere 1 2 3 -1 stone") == "s.txt:1: R: \"-1\" is not a number in its range");
  CHECK(message_of("stroke 0 stone 1 2 3 4 5 6") ==
        "s.txt:1: R: \"0\" is not a number in its range");
  CHECK(message_of("stroke 1 stone 1 2 3") == "s.txt:1: a stroke needs two positions or more");
  CHECK(message_of("stroke 1 stone 1 2 3 solid 4 5 6") ==
        "s.txt:1: a stroke needs two positions or more");
  CHECK(message_of("stroke 1 stone 1 2 3 4 5") == "s.txt:1: expected Z");
  CHECK(message_of("stroke 1 stone 1 2 3 4 5 6 solid 7") == "s.txt:1: unexpected \"7\"");
  CHECK(message_of("copy") == "s.txt:1: expected NAME");
  CHECK(message_of("copy a 1 2 3 4 5 6 empty") == "s.txt:1: unexpected \"empty\"");
  CHECK(message_of("paste a 1 2 3 mirror w") == "s.txt:1: AXIS: \"w\" is none of x, y, z");
  CHECK(message_of("paste a 1 2 3 rotate 4") ==
        "s.txt:1: QUARTERS: \"4\" is not a number in its range");
  CHECK(message_of("paste a 1 2 3 solid rotate 1") == "s.txt:1: unexpected \"rotate\"");
  CHECK(message_of("walk 1 2 3 0") == "s.txt:1: SPEED: \"0\" is not a number in its range");
  CHECK(message_of("box 1 2 3 4 5 6 stone some") ==
        "s.txt:1: MASK: \"some\" is none of empty, solid, only:MATERIAL");
  CHECK(message_of("wait ready") ==
        "s.txt:1: \"ready\" is none of SECONDS, loaded, horizon, durable, synced, chat");
  CHECK(message_of("wait -1") ==
        "s.txt:1: \"-1\" is none of SECONDS, loaded, horizon, durable, synced, chat");
  CHECK(message_of("repeat 2\ndig") == "s.txt:1: repeat without end");
  CHECK(message_of("end") == "s.txt:1: end without repeat");
  CHECK(message_of("look 10 91") == "s.txt:1: PITCH: \"91\" is not a number in its range");
  CHECK(message_of("burst 10 0 1 1 stone") == "s.txt:1: RATE: \"0\" is not a number in its range");
  std::string deep;
  for (int i = 0; i < 9; ++i) deep += "repeat 1\n";
  CHECK(message_of(deep) == "s.txt:9: repeat is nested too deeply");
}

TEST_CASE("travel takes a sequence, a number of seconds ago, or the live world", "[bots]") {
  const auto script = parse_script("travel 12\ntravel -90.5\ntravel live\n", "t");
  REQUIRE(script.has_value());
  const auto step = [&](std::size_t i) {
    return std::get<script::HistoryRequest>(script->commands[i].step);
  };
  CHECK(step(0).to == HistoryTarget::sequence);
  CHECK(step(0).seq == 12);
  CHECK(step(1).to == HistoryTarget::time);
  CHECK(step(1).seconds_ago == 90.5);
  CHECK(step(2).to == HistoryTarget::live);
  for (const char* wrong :
       {"travel", "travel back", "travel -x", "travel 1 2", "travel 99999999999999999999"}) {
    CAPTURE(wrong);
    const auto refused = parse_script(wrong, "t");
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().line == 1);
  }
}
