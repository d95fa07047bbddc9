#include "client/session/shared_previews.hpp"

#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::shared_previews_test {

using namespace session_bench;

namespace {

const std::vector<EditDescriptor> kNothing;

std::vector<EditDescriptor> one(std::int32_t x) { return {set({x, 0, 0}, 1)}; }

}  // namespace

TEST_CASE("a preview is sent when it changes, but not too often, and repeated",
          "[client_session]") {
  SharedPreviews previews;
  CHECK_FALSE(previews.share(kNothing, 16, 0));
  CHECK(previews.share(one(1), 16, 10) == PreviewShare{one(1)});
  CHECK_FALSE(previews.share(one(2), 16, 20));  // too soon
  CHECK_FALSE(previews.share(one(1), 16, 300'000));
  CHECK(previews.share(one(2), 16, 300'000) == PreviewShare{one(2)});
  CHECK(previews.share(one(2), 16, 300'000 + SharedPreviews::kRepeatUs) == PreviewShare{one(2)});
  CHECK(previews.share(kNothing, 16, 9'000'000) == PreviewShare{});
  CHECK_FALSE(previews.share(kNothing, 16, 99'000'000));
}

TEST_CASE("a preview that is too large to be shared ends the one before", "[client_session]") {
  SharedPreviews previews;
  CHECK(previews.share(one(1), 16, 0));
  const std::vector<EditDescriptor> large = {{FillSphere{{0, 0, 0}, 64}, {}, 1}};
  CHECK(previews.share(large, 16, 1'000'000) == PreviewShare{});
  CHECK_FALSE(previews.share(large, 16, 5'000'000));
}

TEST_CASE("the previews of others are kept until they are replaced, old, or their player leaves",
          "[client_session]") {
  SharedPreviews previews;
  previews.receive({7, one(1)}, 16, 0);
  previews.receive({8, one(2)}, 16, 100);
  CHECK(previews.others().size() == 2);
  previews.receive({8, {}}, 16, 200);
  CHECK_FALSE(previews.others().contains(8));
  previews.receive({9, {{FillSphere{{0, 0, 0}, 64}, {}, 1}}}, 16, 200);  // a hostile server
  CHECK_FALSE(previews.others().contains(9));
  previews.expire(SharedPreviews::kShownUs - 1);
  CHECK(previews.others().contains(7));
  previews.expire(SharedPreviews::kShownUs);
  CHECK(previews.others().empty());
  for (AuthorId author = 1; author <= 500; ++author) previews.receive({author, one(1)}, 16, 0);
  CHECK(previews.others().size() == SharedPreviews::kAuthorsMax);
}

TEST_CASE("a stroke is shared with its edits, and forgotten when its player edits",
          "[client_session]") {
  BrushStroke stroke;
  stroke.places = {{1, 2, 3}};
  SharedPreviews previews;
  CHECK(previews.share(one(1), 16, 0, stroke) == PreviewShare{one(1), stroke});
  CHECK_FALSE(previews.share(one(1), 16, 300'000, stroke));
  stroke.places.push_back({2, 2, 3});
  CHECK(previews.share(one(1), 16, 300'000, stroke) == PreviewShare{one(1), stroke});
  BrushStroke wrong = stroke;
  wrong.size = 0;
  CHECK(previews.share(one(1), 16, 600'000, wrong) == PreviewShare{one(1)});
  CHECK(previews.share(kNothing, 16, 900'000, stroke) == PreviewShare{});
  previews.receive({7, one(1), stroke}, 16, 0);
  previews.receive({8, one(1)}, 16, 0);
  previews.receive({9, one(1), wrong}, 16, 0);
  CHECK(previews.others().at(7).stroke == stroke);
  CHECK_FALSE(previews.others().at(9).stroke);
  for (const AuthorId author : {7U, 8U, 10U}) previews.forget_stroke(author);
  CHECK_FALSE(previews.others().contains(7));
  CHECK(previews.others().contains(8));
}

TEST_CASE_METHOD(SessionBench, "a session shares a preview only with a server that has the feature",
                 "[client_session]") {
  greet();
  CHECK((server.hello.features & kFeaturePreviews) != 0);
  Welcome welcome = server.make_welcome();
  const bool has_feature = GENERATE(false, true);
  welcome.features = has_feature ? kFeaturePreviews : 0;
  welcome.signature =
      sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
  receive(welcome);
  receive(SessionAccepted{6, 0});
  static_cast<void>(sent());
  session.share_preview(one(1), now);
  CHECK(take<PreviewShare>(sent()).size() == (has_feature ? 1 : 0));
  if (!has_feature) return;
  receive(PlayerList{{{8, "ben", keys(3).public_key}}, false, {}});
  receive(PlayerPreview{8, one(3)});
  receive(PlayerPreview{6, one(4)});  // of this player
  REQUIRE(session.others_previews().size() == 1);
  CHECK(session.others_previews().at(8).edits == one(3));
  receive(PlayerList{{}, true, {8}});
  CHECK(session.others_previews().empty());
  receive(PlayerPreview{8, one(3)});
  session.disconnected();
  CHECK(session.others_previews().empty());
}

}  // namespace runstone::test::shared_previews_test
