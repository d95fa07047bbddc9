// The example in C that joins a server, run as a program.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/integration/server/app/server_bench.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("the example in C joins a server and sets a voxel", "[c_interface][examples]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  CHECK(std::system((std::string(EXAMPLE_C_JOIN_PROGRAM) +
                     " 127.0.0.1:" + std::to_string(server->port()) + " >/dev/null")
                        .c_str()) == 0);
  CHECK(server->stop().digests.seq == 1);
}
