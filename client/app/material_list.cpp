#include "client/app/material_list.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "client/app/threaded_session.hpp"
#include "client/net/wake_up.hpp"
#include "client/report/exit_code.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {

std::string material_list(const MaterialTable& materials) {
  const std::size_t width = std::to_string(materials.size() - 1).size();
  std::string out;
  for (std::size_t id = 0; id < materials.size(); ++id)
    out += fmt::format("{:>{}} {}\n", id, width, materials.rows()[id].name);
  return out;
}

int list_materials(const ClientOptions& options, const volatile std::sig_atomic_t& stop) {
  WakeUp wake;
  ThreadedSession network(options, [&wake] { wake.notify(); });
  network.start(steady_now_us());
  std::string failure = "interrupted";
  while (stop == 0) {
    network.receive();
    if (network.take_world_opened()) {
      std::fputs(material_list(network.session().welcome()->materials).c_str(), stdout);
      network.finish();
      return kExitOk;
    }
    const TimeUs now_us = steady_now_us();
    auto end = network.refusal();
    if (!end) end = network.timeout(now_us);
    if (end) {
      failure = *end;
      break;
    }
    network.session().tick(now_us);
    network.flush();
    wake.wait(std::chrono::milliseconds(10));
  }
  network.finish();
  std::fprintf(stderr, "runstone-client: %s\n", failure.c_str());
  return kExitNoStart;
}

}  // namespace runstone
