// The includes of the tree must follow the arrows between modules. An arrow is a DEPS entry of
// runstone_module() in a CMakeLists.txt: a module may include its own headers and those of its
// DEPS. In addition:
// - The pure folders (common/ without os, postgres, sql and sqlite, and protocol/) include no header for sockets,
//   files, clocks, threads, logs or graphics.
// - The folders of authority and replica include no header for sockets, clocks or threads.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

struct SourceFile {
  std::string path;  // from the repository root, with forward slashes
  std::string text;
};

struct Include {
  std::string path;
  bool quoted = false;  // "..." rather than <...>
};

bool below(std::string_view path, std::string_view folder) {
  return path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

std::vector<Include> includes_of(const std::string& text) {
  std::vector<Include> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view kBlank = " \t";
    std::size_t at = line.find_first_not_of(kBlank);
    if (at == std::string::npos || line[at] != '#') continue;
    at = line.find_first_not_of(kBlank, at + 1);
    if (at == std::string::npos || line.compare(at, 7, "include") != 0) continue;
    at = line.find_first_not_of(kBlank, at + 7);
    if (at == std::string::npos || (line[at] != '"' && line[at] != '<')) continue;
    const bool quoted = line[at] == '"';
    const std::size_t end = line.find(quoted ? '"' : '>', at + 1);
    if (end != std::string::npos) out.push_back({line.substr(at + 1, end - at - 1), quoted});
  }
  return out;
}

using Arrows = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Returns the folder of each module, and the folders from which it may include: what CMake wrote
/// from DEPS.
const Arrows& arrows() {
  static const Arrows kArrows = [] {
    Arrows out;
    std::ifstream in(RUNSTONE_ARROWS_FILE);
    for (std::string line; std::getline(in, line);) {
      const std::size_t colon = line.find(':');
      if (colon == std::string::npos) continue;
      std::istringstream words(line.substr(colon + 1));
      std::vector<std::string>& deps = out[line.substr(0, colon)];
      for (std::string dep; words >> dep;) deps.push_back(dep);
    }
    return out;
  }();
  return kArrows;
}

/// Returns the innermost module whose folder contains the path, or arrows().end() if there is none.
Arrows::const_iterator module_of(std::string_view path) {
  auto found = arrows().end();
  for (auto at = arrows().begin(); at != arrows().end(); ++at) {
    if (below(path, at->first) &&
        (found == arrows().end() || at->first.size() > found->first.size()))
      found = at;
  }
  return found;
}

/// Returns true if no module of this build need contain the path: tests are not modules, and a build
/// without the client or the benchmarks has no modules below client/, bindings/web/ or bench/.
bool is_outside(std::string_view path) {
#ifndef RUNSTONE_HAS_CLIENT
  if (below(path, "client") || below(path, "bindings/web")) return true;
#endif
  return below(path, "tests") || below(path, "bench");
}

/// Headers that a folder may not include, as <...> or "...". A prefix that ends in '/' names a
/// folder of headers.
struct Ban {
  std::vector<std::string> folders;
  std::vector<std::string> headers;
  const char* rule = "this folder does no I/O, reads no clock and starts no thread";
};

const std::vector<Ban>& bans() {
  static const std::vector<Ban> kBans = {
      {{"common/core", "common/runs", "common/materials", "common/edits", "common/mesh",
        "common/tiles", "common/map", "common/generate", "common/rlog", "common/formats",
        "protocol"},
       {"common/os/",   "common/postgres/", "common/sql/", "common/sqlite/", "asio.hpp",
        "asio/",        "boost/",           "spdlog/",     "sqlite3.h",      "libpq-fe.h",
        "GL/",          "GLES2/",           "GLES3/",      "GLFW/",          "EGL/",
        "epoxy/",       "chrono",           "ctime",       "time.h",         "thread",
        "fstream",      "iostream",         "random",      "unistd.h",       "sys/time.h",
        "sys/socket.h", "filesystem"}},
      {{"server/world", "server/interest", "client/replica"},
       {"asio.hpp", "asio/", "boost/", "sqlite3.h", "libpq-fe.h", "chrono", "ctime", "time.h",
        "thread", "fstream", "random", "unistd.h", "sys/time.h", "sys/socket.h", "common/os/",
        "common/postgres/", "common/sql/", "common/sqlite/"}},
  };
  return kBans;
}

bool names(const std::string& header, const std::string& banned) {
  return banned.ends_with('/') ? header.starts_with(banned) : header == banned;
}

/// Returns one line for each wrong include: "file includes header: rule".
std::vector<std::string> wrong_includes(const std::vector<SourceFile>& files) {
  static constexpr std::string_view kRoots[] = {"bindings", "common", "protocol", "server",
                                                "client",   "bench",  "tests"};
  std::vector<std::string> out;
  for (const SourceFile& file : files) {
    const auto home = module_of(file.path);
    if (home == arrows().end() && !is_outside(file.path)) {
      out.push_back(file.path + " lies in no module");
      continue;
    }
    for (const Include& include : includes_of(file.text)) {
      const auto complain = [&](const char* rule) {
        out.push_back(file.path + " includes " + include.path + ": " + rule);
      };
      for (const Ban& ban : bans()) {
        const bool applies = std::any_of(ban.folders.begin(), ban.folders.end(),
                                         [&](const auto& f) { return below(file.path, f); });
        if (applies && std::any_of(ban.headers.begin(), ban.headers.end(), [&](const auto& banned) {
              return names(include.path, banned);
            })) {
          complain(ban.rule);
        }
      }
      const bool ours = std::any_of(
          std::begin(kRoots), std::end(kRoots),
          [&](std::string_view root) { return include.path.starts_with(std::string(root) + "/"); });
      if (ours != include.quoted) {
        complain(
            "headers of this repository are quoted, from its root; "
            "all others stand in angle brackets");
        if (!ours) continue;
      }
      if (!ours || home == arrows().end()) continue;
      if (include.path.starts_with("protocol/schema/")) continue;  // generated at build time
      const auto target = module_of(include.path);
      if (target == arrows().end() && below(include.path, "client") && is_outside(include.path))
        continue;
      if (target == home) continue;
      if (target == arrows().end() || std::find(home->second.begin(), home->second.end(),
                                                target->first) == home->second.end()) {
        complain("the module does not name that one in its DEPS");
      }
    }
  }
  return out;
}

std::vector<SourceFile> source_tree(const std::filesystem::path& root) {
  std::vector<SourceFile> out;
  for (const char* folder :
       {"bindings", "common", "protocol", "server", "client", "bench", "tests"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      const auto extension = entry.path().extension();
      // The module of Python is no room: it is built only with RUNSTONE_PYTHON.
      if (below(entry.path().lexically_relative(root).generic_string(), "bindings/python"))
        continue;
      if (!entry.is_regular_file() ||
          (extension != ".hpp" && extension != ".cpp" && extension != ".h"))
        continue;
      std::ifstream in(entry.path(), std::ios::binary);
      out.push_back({entry.path().lexically_relative(root).generic_string(),
                     {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}});
    }
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return out;
}

// Returns true if a file with this one line breaks a rule.
bool is_wrong(const std::string& path, const std::string& line) {
  return !wrong_includes({{path, "#pragma once\n" + line + "\nint x;\n"}}).empty();
}

}  // namespace

TEST_CASE("every include of the tree follows the arrows of the house", "[house]") {
  REQUIRE(arrows().size() > 20);
  const std::vector<SourceFile> files = source_tree(RUNSTONE_SOURCE_DIR);
  REQUIRE(files.size() > 100);
  for (const char* folder : {"common/core", "common/runs", "common/edits", "common/os", "protocol",
                             "server", "client"}) {
    CAPTURE(folder);
    CHECK(std::any_of(files.begin(), files.end(),
                      [&](const auto& f) { return below(f.path, folder); }));
  }
  for (const std::string& complaint : wrong_includes(files)) {
    CAPTURE(complaint);
    CHECK(complaint.empty());
  }
}

TEST_CASE("a planted wrong include is caught", "[house]") {
  // Upwards and sideways.
  CHECK(is_wrong("common/core/ids.hpp", "#include \"common/runs/run_list.hpp\""));
  CHECK(is_wrong("common/runs/run_chunk.cpp", "#include \"common/edits/apply/edit_stack.hpp\""));
  CHECK(is_wrong("common/edits/apply/edit_stack.cpp", "#include \"common/mesh/quad.hpp\""));
  CHECK(is_wrong("common/mesh/rdm/rdm_mesher.cpp",
                 "#include \"common/edits/descriptor/edit_record.hpp\""));
  CHECK(is_wrong("common/mesh/rdm/rdm_mesher.cpp", "#include \"common/generate/generator.hpp\""));
  CHECK(is_wrong("common/generate/hills.cpp", "#include \"common/edits/apply/edit_stack.hpp\""));
  CHECK(is_wrong("common/formats/luanti_block.cpp", "#include \"common/mesh/quad.hpp\""));
  CHECK(is_wrong("common/runs/layer.cpp", "#include \"protocol/limits.hpp\""));
  CHECK(is_wrong("protocol/codec/frame.cpp", "#include \"server/net/session.hpp\""));
  CHECK(is_wrong("server/net/session.cpp", "#include \"client/net/link.hpp\""));
  CHECK(is_wrong("client/net/link.cpp", "#include \"server/net/session.hpp\""));
  CHECK(is_wrong("common/core/hash.cpp", "#include \"common/os/steady_clock.hpp\""));
  CHECK(is_wrong("protocol/codec/frame.cpp", "#include \"common/os/steady_clock.hpp\""));
  CHECK(is_wrong("common/os/open_files.cpp", "#include \"protocol/limits.hpp\""));
  CHECK(is_wrong("common/os/open_files.cpp", "#include \"server/app/server.hpp\""));
  CHECK(is_wrong("client/app/client_main.cpp", "#include \"tests/support/runs/dense_chunk.hpp\""));
  // System headers in the pure libraries.
  for (const char* header :
       {"asio.hpp", "asio/ip/tcp.hpp", "spdlog/spdlog.h", "sqlite3.h", "libpq-fe.h", "GL/gl.h",
        "GLFW/glfw3.h", "chrono", "thread", "fstream"}) {
    CAPTURE(header);
    CHECK(is_wrong("common/edits/apply/edit_stack.cpp", "#include <" + std::string(header) + ">"));
    CHECK(is_wrong("protocol/codec/frame.hpp", "#include <" + std::string(header) + ">"));
  }
  CHECK(is_wrong("server/world/order/authority.cpp", "#include <chrono>"));
  CHECK(is_wrong("client/replica/replica.cpp", "#include <asio.hpp>"));
  CHECK(is_wrong("client/replica/replica.cpp", "#include \"common/os/steady_clock.hpp\""));
  CHECK(is_wrong("server/world/order/authority.cpp", "#include \"common/os/steady_clock.hpp\""));
  // The libraries know nothing of the interface around them.
  CHECK(is_wrong("common/mesh/quad.hpp", "#include \"bindings/c/runstone.h\""));
  CHECK(is_wrong("bindings/c/chunk_calls.cpp", "#include \"client/replica/replica.hpp\""));
  // Test code in the product.
  CHECK(is_wrong("client/schedule/mesh_job.cpp", "#include \"tests/reference/binary_greedy.hpp\""));
  CHECK(is_wrong("common/mesh/rdm/rdm_mesher.cpp", "#include \"tests/reference/dense_grid.hpp\""));
  CHECK(is_wrong("client/schedule/mesh_job.cpp", "#include \"bench/worlds/town.hpp\""));
  // Other spellings.
  CHECK(is_wrong("common/core/ids.hpp", "  #  include\t\"common/runs/run_list.hpp\""));
  CHECK(is_wrong("common/core/ids.hpp", "#include <common/core/hash.hpp>"));
  CHECK(is_wrong("common/core/ids.hpp", "#include \"hash.hpp\""));
  CHECK(is_wrong("common/core/ids.hpp", "#include \"../runs/run_list.hpp\""));
  CHECK(is_wrong("common/corelike/ids.hpp", "#include <vector>"));
}

TEST_CASE("right includes pass", "[house]") {
  CHECK_FALSE(is_wrong("common/core/hash.cpp", "#include \"common/core/ids.hpp\""));
  CHECK_FALSE(is_wrong("common/core/hash.cpp", "#include <vector>"));
  CHECK_FALSE(
      is_wrong("common/edits/apply/edit_stack.cpp", "#include \"common/runs/dirty_layers.hpp\""));
  CHECK_FALSE(
      is_wrong("common/mesh/rdm/rdm_mesher.cpp", "#include \"common/runs/dirty_layers.hpp\""));
  CHECK_FALSE(is_wrong("common/formats/luanti_block.cpp", "#include <zstd.h>"));
  CHECK_FALSE(
      is_wrong("protocol/codec/frame.cpp", "#include \"common/edits/descriptor/edit_record.hpp\""));
  CHECK_FALSE(is_wrong("common/os/steady_clock.hpp", "#include <chrono>"));
  CHECK_FALSE(is_wrong("server/net/session.cpp", "#include \"common/os/steady_clock.hpp\""));
  CHECK_FALSE(is_wrong("client/net/link.cpp", "#include \"common/os/steady_clock.hpp\""));
  CHECK_FALSE(is_wrong("server/net/session.cpp", "#include <asio.hpp>"));
  CHECK_FALSE(is_wrong("server/rollback/job.cpp", "#include \"server/world/world_server.hpp\""));
  CHECK_FALSE(is_wrong("client/replica/replica.cpp", "#include \"protocol/codec/frame.hpp\""));
  CHECK_FALSE(is_wrong("tests/simulation/client/session/replica_test.cpp",
                       "#include \"client/replica/replica.hpp\""));
  CHECK_FALSE(is_wrong("bindings/c/chunk_calls.cpp", "#include \"common/runs/dense.hpp\""));
  CHECK_FALSE(is_wrong("common/core/hash.cpp", "// #include <chrono>"));
}
