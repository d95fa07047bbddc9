// Players see what the others are about to do, over real connections to a real server on loopback.
#include <catch2/catch.hpp>
#include <optional>

#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"

namespace runstone::test {

TEST_CASE("a preview reaches the other players, changes with the aim, and goes with its player",
          "[travel]") {
  constexpr View kView{1, {0, 0, 0}, 2, 1};
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  LiveSession watcher(server->port(), kView);
  std::optional<LiveSession> builder(std::in_place, server->port(), kView);
  watcher.catch_up();
  builder->catch_up();
  const AuthorId author = builder->session().author();
  const auto shows = [&](const std::vector<EditDescriptor>& edits) {
    builder->session().share_preview(edits, steady_now_us());
    builder->pump();
    const auto& others = watcher.session().others_previews();
    const auto found = others.find(author);
    return found == others.end() ? edits.empty() : found->second.edits == edits;
  };
  const std::vector<EditDescriptor> here = {{FillSphere{{2, 8, 2}, 3}, {}, 5}};
  const std::vector<EditDescriptor> there = {{FillBox{{{4, 4, 4}, {9, 6, 9}}}, {}, kEmpty},
                                             {SetVoxel{{4, 9, 4}}, {}, 2}};
  watcher.until([&] { return shows(here); });
  watcher.until([&] { return shows(there); });
  watcher.until([&] { return shows({}); });
  watcher.until([&] { return shows(here); });
  CHECK(builder->session().others_previews().empty());  // nobody gets his own
  CHECK(watcher.replica().shown_at({2, 8, 2}) == kEmpty);
  builder.reset();
  watcher.until([&] { return watcher.session().others_previews().empty(); });
  server->stop();
}

}  // namespace runstone::test
