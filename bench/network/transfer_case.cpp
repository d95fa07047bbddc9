#include "bench/network/transfer_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/network/transfer_scene.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::bench {
namespace {

using asio::ip::tcp;

constexpr unsigned kTransferEdge = 32;
constexpr std::int32_t kSide = 4;        // chunks of a world's scene along each axis
constexpr double kSecondsPerCell = 3;    // repetitions end after this time
constexpr double kWinningMargin = 1.02;  // a smaller difference is a draw

/// The median times of one scene, form and link, in ms.
struct Cell {
  std::string profile, link, scene;
  Transfer transfer = Transfer::dense;
  std::size_t bytes = 0, chunks = 0, quads = 0;
  unsigned repetitions = 0;
  double transfer_ms = 0, unpack_ms = 0, mesh_ms = 0, complete_ms = 0;
};

TransferScene scenario_of(unsigned number) {
  TransferScene out;
  out.name = fmt::format("scenario {}", number);
  out.edge = kTransferEdge;
  out.visibility = std::make_shared<const VisibilityTable>(test::scenario_visibility());
  const auto world = test::scenario_generator(number, kTransferEdge);
  for (std::int32_t x = -1; x <= 1; ++x) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t z = -1; z <= 1; ++z) {
        out.chunks[{x, y, z}] = test::scenario_scene(*world, {x, y, z}, kTransferEdge, true).chunk;
      }
    }
  }
  return out;
}

/// Returns the chunks around the origin, or in the middle of a world with bounds.
TransferScene scene_of(const VoxelWorld& world) {
  TransferScene out;
  out.name = world.name;
  out.edge = kTransferEdge;
  out.visibility = world.visibility;
  VoxelPos middle{};
  if (world.bounds) {
    const VoxelBox& box = *world.bounds;
    middle = {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2,
              (box.min.z + box.max.z) / 2};
  }
  const ChunkCoord at = chunk_of(middle, kTransferEdge);
  for (std::int32_t x = at.x - kSide / 2; x < at.x + kSide / 2; ++x) {
    for (std::int32_t y = at.y - kSide / 2; y < at.y + kSide / 2; ++y) {
      for (std::int32_t z = at.z - kSide / 2; z < at.z + kSide / 2; ++z) {
        out.chunks[{x, y, z}] =
            chunk_of_world(world, origin_of({x, y, z}, kTransferEdge), kTransferEdge);
      }
    }
  }
  return out;
}

/// The place where a sender listens, and the port by which the receiver reaches it.
struct Source {
  asio::io_context io;
  std::optional<tcp::acceptor> acceptor;
  std::uint16_t entrance = 0;
};

Done listen(TestbedLink& link, Source& source) {
  link.server_side().run([&] {
    source.acceptor.emplace(source.io,
                            tcp::endpoint(asio::ip::make_address(link.server_address()), 0));
  });
  const auto port = link.entrance(source.acceptor->local_endpoint().port());
  if (!port) return failure(port.error());
  source.entrance = *port;
  return {};
}

/// Waits for a connection and for a byte on it, and sends all bytes.
void serve_once(tcp::acceptor& acceptor, const Bytes& bytes) {
  asio::error_code error;
  tcp::socket socket = acceptor.accept(error);
  if (error) return;
  socket.set_option(tcp::no_delay(true), error);
  std::uint8_t request = 0;
  socket.read_some(asio::buffer(&request, 1), error);
  if (!error) asio::write(socket, asio::buffer(bytes), error);
  if (!error)
    // This read waits until the receiver has all bytes and closes.
    socket.read_some(asio::buffer(&request, 1), error);
}

struct Received {
  // The times from the request until the last byte was read, and until the last chunk was meshed.
  double transfer_ms = 0, complete_ms = 0;
  TransferTimes times;
};

Result<Received, std::string> receive_once(TestbedLink& link, Source& source,
                                           const TransferScene& scene, Transfer transfer,
                                           const Bytes& bytes) {
  asio::error_code error;
  tcp::socket socket(source.io);
  link.client_side().run([&] { socket.open(tcp::v4(), error); });
  if (!error)
    socket.connect({asio::ip::make_address(link.server_address()), source.entrance}, error);
  if (!error) socket.set_option(tcp::no_delay(true), error);
  if (error) return failure("cannot connect: " + error.message());
  std::thread sender([&] { serve_once(*source.acceptor, bytes); });
  SceneReceiver receiver(scene, transfer);
  Received out;
  Done fed;
  const std::uint64_t start = now_ns();
  const auto since_ms = [start] { return static_cast<double>(now_ns() - start) / 1e6; };
  asio::write(socket, asio::buffer("?", 1), error);
  std::array<std::uint8_t, 65536> buffer;
  for (std::size_t left = bytes.size(); left != 0 && !error && fed;) {
    const std::size_t got = socket.read_some(asio::buffer(buffer), error);
    left -= got;
    if (left == 0) out.transfer_ms = since_ms();
    fed = receiver.feed(ByteView(buffer.data(), got));
  }
  out.complete_ms = since_ms();
  out.times = receiver.times();
  asio::error_code ignored;
  socket.close(ignored);
  sender.join();
  if (error) return failure("a transfer broke off: " + error.message());
  if (!fed) return failure(fed.error());
  if (!receiver.complete()) return failure(scene.name + " did not become a whole picture");
  return out;
}

/// Measures one scene in one form on one link, until there are enough repetitions or their time is
/// over.
Result<Cell, std::string> measure_cell(Testbed& testbed, TestbedLink& link,
                                       const TransferScene& scene, Transfer transfer,
                                       std::uint64_t& faces) {
  const Bytes bytes = encode_scene(scene, transfer);
  Source source;
  if (const auto listens = listen(link, source); !listens) return failure(listens.error());
  std::array<std::vector<double>, 4> samples;
  Cell out;
  const std::uint64_t start = now_ns();
  while (out.repetitions < testbed.options().repetitions &&
         (out.repetitions == 0 || static_cast<double>(now_ns() - start) < kSecondsPerCell * 1e9)) {
    const auto once = receive_once(link, source, scene, transfer, bytes);
    if (!once) return failure(once.error());
    if (interrupted()) return failure("interrupted");
    if (faces == 0) faces = once->times.faces;
    if (once->times.faces != faces) {
      return failure(fmt::format("{} as {} is another picture", scene.name, name_of(transfer)));
    }
    ++out.repetitions;
    out.quads = once->times.quads;
    samples[0].push_back(once->transfer_ms);
    samples[1].push_back(static_cast<double>(once->times.unpack_ns) / 1e6);
    samples[2].push_back(static_cast<double>(once->times.mesh_ns) / 1e6);
    samples[3].push_back(once->complete_ms);
  }
  out.scene = scene.name;
  out.transfer = transfer;
  out.bytes = bytes.size();
  out.chunks = scene.chunks.size();
  out.transfer_ms = median(samples[0]);
  out.unpack_ms = median(samples[1]);
  out.mesh_ms = median(samples[2]);
  out.complete_ms = median(samples[3]);
  return out;
}

Result<std::vector<TransferScene>, std::string> scenes_of(const NetOptions& options) {
  std::vector<TransferScene> out;
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    if (const VoxelWorld* world = worlds->voxels(w)) {
      out.push_back(scene_of(*world));
      continue;
    }
    constexpr unsigned kQuickStep = 6;  // every sixth
    for (unsigned number = 1; number <= kScenarioCount; number += options.quick ? kQuickStep : 1) {
      out.push_back(scenario_of(number));
    }
  }
  return out;
}

/// The four forms of one scene on one link.
using Four = std::array<const Cell*, kTransfers.size()>;

const Cell& of(const Four& four, Transfer transfer) {
  return *four[static_cast<std::size_t>(transfer)];
}
bool is_scenario(const Four& four) { return four[0]->scene.starts_with("scenario"); }
double ratio(const Four& four, Transfer against) {
  return of(four, against).complete_ms / of(four, Transfer::packed).complete_ms;
}

std::string millis(const std::vector<Four>& rows, Transfer transfer, double Cell::* time) {
  std::vector<double> samples;
  for (const Four& four : rows) samples.push_back(of(four, transfer).*time);
  return number_text(median(samples));
}

/// Writes a row for each link, world and form; for the scenarios, medians.
void write_rows(const std::vector<Four>& all, std::string& out) {
  const auto into = std::back_inserter(out);
  fmt::format_to(
      into,
      "| link | scene | form | KB | transfer ms | unpack ms | mesh ms | picture complete ms | "
      "packed + RDM is faster by |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < all.size();) {
    std::vector<Four> rows = {all[i++]};
    while (is_scenario(rows[0]) && i < all.size() && is_scenario(all[i]) &&
           all[i][0]->profile == rows[0][0]->profile) {
      rows.push_back(all[i++]);
    }
    for (const Transfer transfer : kTransfers) {
      std::vector<double> kb, faster;
      for (const Four& four : rows) {
        kb.push_back(static_cast<double>(of(four, transfer).bytes) / 1000);
        faster.push_back(ratio(four, transfer));
      }
      const Cell& first = *rows[0][0];
      fmt::format_to(
          into, "| {} ({}) | {} | {} | {} | {} | {} | {} | {} | {:.2f}x |\n", first.profile,
          first.link, rows.size() == 1 ? first.scene : fmt::format("{} scenarios", rows.size()),
          name_of(transfer), number_text(median(kb)), millis(rows, transfer, &Cell::transfer_ms),
          millis(rows, transfer, &Cell::unpack_ms), millis(rows, transfer, &Cell::mesh_ms),
          millis(rows, transfer, &Cell::complete_ms), geometric_mean(faster));
    }
  }
}

/// Writes when packed runs with RDM complete a scene first, by how much, and when they do not.
void write_answer(const std::vector<Four>& all, std::string& out) {
  const auto into = std::back_inserter(out);
  fmt::format_to(into,
                 "\nTime to the complete picture against packed runs and RDM, "
                 "all scenes alike (geometric mean; lowest, highest; "
                 "how often packed is first, draws within 2 % apart):\n\n"
                 "| link | dense | dense_zstd | raw |\n"
                 "|---|---|---|---|\n");
  for (std::size_t i = 0; i < all.size();) {
    const std::string& profile = all[i][0]->profile;
    std::vector<Four> rows;
    for (; i < all.size() && all[i][0]->profile == profile; ++i) rows.push_back(all[i]);
    fmt::format_to(into, "| {} |", profile);
    for (const Transfer against : {Transfer::dense, Transfer::dense_zstd, Transfer::raw}) {
      std::vector<double> ratios;
      for (const Four& four : rows) ratios.push_back(ratio(four, against));
      const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
      const auto wins =
          std::count_if(ratios.begin(), ratios.end(), [](double r) { return r > kWinningMargin; });
      const auto losses = std::count_if(ratios.begin(), ratios.end(),
                                        [](double r) { return r < 1 / kWinningMargin; });
      fmt::format_to(into, " {:.2f}x; {:.2f} to {:.2f}; first in {} of {}, last in {} |",
                     geometric_mean(ratios), *low, *high, wins, ratios.size(), losses);
    }
    fmt::format_to(into, "\n");
  }
}

void add_figures(const Cell& cell, std::vector<Figure>& figures) {
  const auto add = [&](const char* name, double value) {
    figures.push_back({"transfer", cell.profile, cell.link,
                       fmt::format("{} {}", cell.scene, name_of(cell.transfer)), name, value});
  };
  add("chunks", static_cast<double>(cell.chunks));
  add("bytes", static_cast<double>(cell.bytes));
  add("quads", static_cast<double>(cell.quads));
  add("repetitions", cell.repetitions);
  add("transfer_ms", cell.transfer_ms);
  add("unpack_ms", cell.unpack_ms);
  add("mesh_ms", cell.mesh_ms);
  add("complete_ms", cell.complete_ms);
}

}  // namespace

Done measure_transfers(Testbed& testbed, NetFindings& findings) {
  const auto scenes = scenes_of(testbed.options());
  if (!scenes) return failure(scenes.error());
  std::vector<std::array<Cell, kTransfers.size()>> cells;
  for (const test::LinkProfile& profile : testbed.profiles()) {
    for (const TransferScene& scene : *scenes) {
      auto link = testbed.make_link(profile);
      if (!link) return failure(link.error());
      auto& row = cells.emplace_back();
      std::uint64_t faces = 0;
      for (const Transfer transfer : kTransfers) {
        auto cell = measure_cell(testbed, **link, scene, transfer, faces);
        if (!cell) return failure(fmt::format("transfer, {}: {}", profile.name, cell.error()));
        cell->profile = profile.name;
        cell->link = name_of((*link)->kind());
        add_figures(*cell, findings.figures);
        row[static_cast<std::size_t>(transfer)] = *std::move(cell);
      }
    }
    fmt::print(testbed.progress(), "transfer {}\n", profile.name);
    testbed.progress().flush();
  }
  std::vector<Four> all;
  for (const auto& row : cells) all.push_back({&row[0], &row[1], &row[2], &row[3]});
  findings.tables += fmt::format(
      "\n### Transfers\n\n"
      "Medians of up to {} repetitions. Dense forms are meshed by binary greedy meshing, "
      "runs by RDM.\n\n",
      testbed.options().repetitions);
  write_rows(all, findings.tables);
  write_answer(all, findings.tables);
  return {};
}

}  // namespace runstone::bench
