#include "bench/servers/fan_out_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/harness/statistics.hpp"
#include "bench/servers/fan_out_senders.hpp"
#include "common/os/open_files.hpp"

namespace runstone::bench {
namespace {

constexpr std::array<std::size_t, 3> kBodyBytes = {200, 1'000, 2'500};
constexpr std::array<unsigned, 2> kPausesMs = {1, 20};
constexpr unsigned kBlocks = 5;        // of each sender
constexpr unsigned kRoundsToWarm = 2;  // at the begin of each block, not counted

using Senders = std::array<FanOutSender*, 2>;

/// Returns the medians of both senders, in microseconds for each receiver.
std::array<double, 2> measure_fan_out(const Senders& senders, std::size_t receivers,
                                      std::size_t body_bytes, unsigned pause_ms, unsigned rounds) {
  std::array<std::vector<double>, 2> us;
  for (unsigned block = 0; block < kBlocks; ++block) {
    for (std::size_t which = 0; which < senders.size(); ++which) {
      for (unsigned round = 0; round < kRoundsToWarm + rounds; ++round) {
        std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
        const auto ns = static_cast<double>(senders[which]->send_to_all(body_bytes));
        if (round >= kRoundsToWarm)
          us[which].push_back(ns / 1'000 / static_cast<double>(receivers));
      }
    }
  }
  return {median(us[0]), median(us[1])};
}

}  // namespace

Result<FanOutResult, std::string> run_fan_out_bench(const BenchOptions& options,
                                                    std::ostream& progress) {
  FanOutResult out{this_machine(), options.clients, {}};
  constexpr std::size_t kFilesOfReceiver = 4, kOtherFiles = 64;
  if (const std::size_t needed = kFilesOfReceiver * out.receivers + kOtherFiles;
      allow_open_files(needed) < needed)
    return failure("the system allows too few open files for so many receivers");
  for (const bool is_encrypted : {false, true}) {
    const auto floor = make_floor_sender({out.receivers, is_encrypted});
    if (!floor) return failure(floor.error());
    const auto sessions = make_session_sender({out.receivers, is_encrypted});
    if (!sessions) return failure(sessions.error());
    for (const std::size_t body_bytes : kBodyBytes) {
      for (const unsigned pause_ms : kPausesMs) {
        const auto us = measure_fan_out({floor->get(), sessions->get()}, out.receivers, body_bytes,
                                        pause_ms, options.repetitions);
        out.rows.push_back({body_bytes, is_encrypted, pause_ms, us[0], us[1]});
        fmt::print(progress, "{} bytes, {} ms, {}\n", body_bytes, pause_ms,
                   is_encrypted ? "with TLS" : "without TLS");
      }
    }
  }
  return out;
}

void write_table(const FanOutResult& result, std::ostream& out) {
  fmt::print(out,
             "{} receivers\n\n| bytes | TLS | pause, ms | floor, µs a receiver | sessions, µs a "
             "receiver | ratio |\n|---|---|---|---|---|---|\n",
             result.receivers);
  for (const FanOutRow& row : result.rows) {
    fmt::print(out, "| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} |\n", row.body_bytes,
               row.is_encrypted ? "yes" : "no", row.pause_ms, row.floor_us, row.sessions_us,
               row.ratio());
  }
}

void write_json(const FanOutResult& result, std::ostream& out) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const FanOutRow& row : result.rows) {
    rows.push_back({{"body_bytes", row.body_bytes},
                    {"is_encrypted", row.is_encrypted},
                    {"pause_ms", row.pause_ms},
                    {"floor_us", row.floor_us},
                    {"sessions_us", row.sessions_us}});
  }
  out << nlohmann::ordered_json{{"receivers", result.receivers}, {"rows", rows}}.dump(2) << '\n';
}

}  // namespace runstone::bench
