// HostChanges: a host who changes rights, materials and names while the server dies again and again.
// Commands go through the control socket, one after another. Each has a subject of its own, so no
// later command replaces what an earlier one did. The host remembers what was answered with exit code
// 0, and looks for it in the lists of the next server.
#pragma once
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/hex.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/control_program.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

class HostChanges {
 public:
  /// `world`: the folder.
  explicit HostChanges(std::string world) : world_(std::move(world)) {}

  /// Gives commands until `is_over` or the server's end. Thread: any, one at a time.
  void work(std::uint16_t port, const std::atomic<bool>& is_over) {
    is_server_gone_ = false;
    while (!is_over && !is_server_gone_) step(port);
  }
  /// Returns how many facts the lists of a running server contradict. Thread: that of the test.
  std::uint64_t missing() const {
    std::uint64_t out = 0;
    for (const auto& [list, facts] : facts_) {
      const Answer answer = control(world_, {list});
      REQUIRE(answer.is_ok);
      for (const auto& [text, is_there] : facts) {
        const bool is_listed = answer.text.find(text) != std::string::npos;
        if (is_listed == is_there) continue;
        WARN(list << (is_there ? " lacks " : " still has ") << text);
        ++out;
      }
    }
    return out;
  }
  /// Returns the number of commands that were answered with exit code 0.
  std::uint64_t answered() const { return answered_; }
  /// Returns the number of commands that were refused, or answered as not on disk yet.
  std::uint64_t not_done() const { return not_done_; }
  /// Returns the number of commands that the death of a server cut.
  std::uint64_t cut() const { return cut_; }

 private:
  static constexpr std::uint32_t kAddress = INADDR_LOOPBACK + 50;
  static constexpr std::uint8_t kFirstKey = 150;
  static constexpr std::uint64_t kKeys = 100;  // a key may own some names only

  /// Gives one command. Returns its answer, or nullopt if the server ended before or refused it.
  std::optional<std::string> give(const std::vector<std::string>& words) {
    std::ostringstream out;
    const auto end = control_server({world_, words}, out);
    is_server_gone_ = !end.has_value();
    const bool is_done = end && *end == ControlEnd::done;
    ++(is_server_gone_ ? cut_ : is_done ? answered_ : not_done_);
    return is_done ? std::optional(out.str()) : std::nullopt;
  }
  /// Gives a command and remembers that `text` is then in the list.
  void change(const std::vector<std::string>& words, const std::string& list,
              const std::string& text) {
    if (give(words)) facts_[list][text] = true;
  }
  /// Makes one change, of each kind in turn.
  void step(std::uint16_t port) {
    const std::uint64_t n = ++steps_;
    const std::string number = std::to_string(kFirstNumber + n);
    switch (n % 7) {
      case 0:
        change({"ban", "198.18." + std::to_string(n / 250) + "." + std::to_string(n % 250),
                "reason", "ban" + number},
               "bans", "\"ban" + number + "\"");
        break;
      case 1:
        change({"mute", key_text(n), "reason", "mute" + number}, "bans", "\"mute" + number + "\"");
        break;
      case 2:
        change({"grant", key_text(n), "moderator"}, "grants",
               key_fingerprint(key_of(n)) + ": moderator");
        break;
      case 3: {
        const std::string x = std::to_string(10 * n), z = "-1000000";
        change({"protect", "box" + number, x, "0", z, x, "9", z}, "protected",
               "box" + number + ": ");
        break;
      }
      case 4:
        invite();
        break;
      case 5:
        add_material("wool" + number);
        break;
      default:
        claim_and_release(port, n, "name" + number);
    }
  }
  void invite() {
    const auto answer = give({"invite", "role", "builder", "uses", "5"});
    if (!answer) return;
    constexpr std::string_view kBefore = "\ninvite ";
    const std::size_t at = answer->find(kBefore);
    RUNSTONE_ASSERT(at != std::string::npos);
    constexpr std::size_t kIdDigits = 16;
    facts_["invites"][answer->substr(at + kBefore.size(), kIdDigits)] = true;
  }
  void add_material(const std::string& name) {
    const std::string file = folder_ / name + ".toml";
    std::ofstream(file) << "[[material]]\nname = \"" + name + "\"\ncolour = \"#80ff20\"\n";
    change({"materials", "add", file}, "materials", name);
  }
  /// A player joins and owns the name. Then the host releases it.
  void claim_and_release(std::uint16_t port, std::uint64_t n, const std::string& name) {
    const std::string listed = "\"" + name + "\"";
    {
      RawClient player(port, kAddress);
      player.name = name;
      player.features = kFeatureNames;
      if (!player.join(static_cast<std::uint8_t>(kFirstKey + n % kKeys))) return;
      facts_["names"][listed] = true;
    }
    if (n % 2 == 0) return;
    facts_["names"].erase(listed);  // until the answer comes, it may be there or not
    if (give({"names", "release", name})) facts_["names"][listed] = false;
  }

  static PublicKey key_of(std::uint64_t n) {
    KeySeed seed{};
    for (std::size_t i = 0; i < sizeof n; ++i) seed[i] = static_cast<std::uint8_t>(n >> (8 * i));
    seed.back() = 1;  // unlike the keys of players
    return key_pair_of(seed).public_key;
  }
  static std::string key_text(std::uint64_t n) { return to_hex(key_of(n)); }

  static constexpr std::uint64_t kFirstNumber = 10'000;  // all numbers have as many digits

  const std::string world_;
  const TempFolder folder_;
  std::map<std::string, std::map<std::string, bool>> facts_;  // by list: a text, and if it is there
  std::uint64_t steps_ = 0, answered_ = 0, not_done_ = 0, cut_ = 0;
  bool is_server_gone_ = false;
};

}  // namespace runstone::test
