// The metrics page.
#include "server/web/metrics_text.hpp"

#include <catch2/catch.hpp>
#include <memory>

namespace runstone {

TEST_CASE("the metrics say what to do about damaged rows", "[web]") {
  auto status = std::make_shared<ServerStatus>();
  status->is_up = true;
  status->counters = {{"commits", 5}, {"row_faults", 2}};
  const WorldStatus world{"", "", status};
  const std::string text = metrics_text(std::span(&world, 1), {});
  using Catch::Matchers::Contains;
  CHECK_THAT(text, Contains("# HELP runstone_row_faults damaged rows of the world") &&
                       Contains("stop the server and run runstone-server repair\n") &&
                       Contains("\nrunstone_row_faults 2\n"));
  CHECK_THAT(text, Contains("# HELP runstone_commits counter of the server with this name\n") &&
                       Contains("\nrunstone_commits 5\n"));
}

}  // namespace runstone
