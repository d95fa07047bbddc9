#include "client/play/view_follower.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/client/session/session_bench.hpp"

using namespace runstone;
using namespace runstone::test::session_bench;

namespace {

/// A session in an open world, and a follower whose view is five columns of one level.
struct FollowerBench : SessionBench {
  FollowerBench() { player.move_to({8, 8, 8}); }

  /// Sends every chunk of the view.
  void send_view_chunks() {
    const View view = session.view();
    for (std::int32_t x = view.centre.x - 1; x <= view.centre.x + 1; ++x) {
      for (std::int32_t z = view.centre.z - 1; z <= view.centre.z + 1; ++z) {
        const ChunkCoord at{x, view.centre.y, z};
        if (view.contains(at)) receive(chunks_of(server.world.snapshot(at), view.number));
      }
    }
  }

  Player player;
  ViewFollower follower{session, player, {1, 0}};
};

}  // namespace

TEST_CASE_METHOD(FollowerBench, "before the world is open there is nothing to follow",
                 "[client_app]") {
  CHECK_FALSE(follower.follow(now));
  CHECK_FALSE(follower.has_followed());
  follower.update_completeness(now);
  CHECK_FALSE(follower.complete_since_us());
}

TEST_CASE_METHOD(FollowerBench, "the view moves with the player, and not more often than its pace",
                 "[client_app]") {
  static_cast<void>(open());
  player.move_to({8 + 3 * kEdge, 8, 8});
  CHECK_FALSE(follower.has_followed());
  CHECK(follower.follow(now));
  CHECK(follower.has_followed());
  CHECK(session.view().centre == ChunkCoord{3, 0, 0});
  CHECK(session.view().radius_h == 1);
  CHECK(session.view().radius_v == 0);
  player.move_to({8 + 4 * kEdge, 8, 8});
  CHECK_FALSE(follower.follow(now + kViewEveryUs - 1));
  CHECK_FALSE(follower.has_followed());
  CHECK(follower.follow(now + kViewEveryUs));
  CHECK(session.view().centre == ChunkCoord{4, 0, 0});
}

TEST_CASE_METHOD(FollowerBench, "a turn gives the session a new direction and the same chunks",
                 "[client_app]") {
  static_cast<void>(open());
  static_cast<void>(follower.follow(now));
  const View before = session.view();
  player.look(2, 0);
  CHECK_FALSE(follower.follow(now + kViewEveryUs));
  CHECK(session.view().same_chunks(before));
  CHECK(session.view().yaw == player.pose().yaw);
}

TEST_CASE_METHOD(FollowerBench, "a view is complete since its last chunk came, until it moves",
                 "[client_app]") {
  static_cast<void>(open());
  player.move_to({8 + 3 * kEdge, 8, 8});
  static_cast<void>(follower.follow(now));
  follower.update_completeness(now);
  CHECK_FALSE(follower.is_complete());
  send_view_chunks();
  CHECK(follower.is_complete());
  CHECK_FALSE(follower.complete_since_us());  // not before the next update
  follower.update_completeness(now + 10);
  follower.update_completeness(now + 20);
  CHECK(follower.complete_since_us() == now + 10);
  player.move_to({8, 8, 8});
  follower.update_completeness(now + 30);
  CHECK_FALSE(follower.complete_since_us());
}

TEST_CASE_METHOD(FollowerBench, "other radii are requested at once, and kept when the player moves",
                 "[client_app]") {
  static_cast<void>(open());
  static_cast<void>(follower.follow(now));
  static_cast<void>(sent());
  const auto sent_radius = [this] {
    const auto views = take<View>(sent());
    REQUIRE(views.size() == 1);
    return views[0].radius_h;
  };
  follower.set_radii({0, 0});
  CHECK(session.view().radius_h == 0);
  CHECK(sent_radius() == 0);
  player.move_to({8 + 3 * kEdge, 8, 8});
  CHECK(follower.follow(now + kViewEveryUs));
  CHECK(sent_radius() == 0);
  follower.set_radii({2, 1});
  CHECK(session.view().centre == ChunkCoord{3, 0, 0});
  CHECK(session.view().radius_v == 1);
  CHECK(sent_radius() == 2);
}

TEST_CASE_METHOD(FollowerBench,
                 "the view has levels of tiles if the server knows them, and only useful ones",
                 "[client_app]") {
  server.features = kFeatureTiles;
  static_cast<void>(open());
  follower.set_far_levels(5);
  CHECK(session.view().levels == 5);
  follower.set_radii({64, 1});
  CHECK(session.view().levels == 5);
  follower.set_far_levels(8);
  CHECK(session.view().levels < 8);
}

TEST_CASE_METHOD(FollowerBench, "the view has no more levels of tiles than the server makes",
                 "[client_app]") {
  server.features = kFeatureTiles;
  server.tile_levels_max = 3;
  static_cast<void>(open());
  follower.set_far_levels(5);
  CHECK(session.view().levels == 3);
  CHECK(session.replica().view()->levels == 3);
}

TEST_CASE_METHOD(FollowerBench, "a server without tiles gets a view without levels",
                 "[client_app]") {
  static_cast<void>(open());
  follower.set_far_levels(5);
  CHECK(session.view().levels == 0);
}
