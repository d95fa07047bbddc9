// CommandBench: a RollbackBench with the other services on which commands work.
#pragma once
#include "server/admin/command_call.hpp"
#include "server/place/place_service.hpp"
#include "tests/unit/server/rollback/rollback_bench.hpp"

namespace runstone::test {

struct CommandBench : RollbackBench {
  using RollbackBench::RollbackBench;
  /// Services without actions of a server, and without operators. The bench must outlive them.
  CommandServices services() {
    return {bench.server,
            service,
            *this,
            placing,
            folder.path(),
            {},
            [](const PublicKey&) {
              return false; }};
  }
  PlaceService placing{bench.server, service, *this, [](std::span<std::uint8_t> out) {
                         for (auto& byte : out) byte = 0x5a;
                       }};
};

}  // namespace runstone::test
