#include "server/admin/control_socket.hpp"

#include <asio/local/stream_protocol.hpp>
#include <asio/post.hpp>
#include <catch2/catch.hpp>
#include <chrono>

#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

TEST_CASE("a connection that comes while the control socket stops does not keep it alive",
          "[admin][control]") {
  const TempFolder folder;
  asio::io_context io;
  auto control = ControlSocket::listen(io, folder.path(),
                                       [](const std::string& /*line*/, const CommandReply&) {});
  REQUIRE(control.has_value());
  asio::io_context client_io;
  asio::local::stream_protocol::socket client(client_io);
  client.connect(asio::local::stream_protocol::endpoint(*control_path(folder.path())));
  // The connection is found before this task runs, and is accepted behind it.
  asio::post(io, [&control] { control->reset(); });
  io.run_for(std::chrono::seconds(20));
  CHECK(io.stopped());
}

}  // namespace runstone::test
