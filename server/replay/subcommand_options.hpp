// SubcommandOptions: the command line of one subcommand of runstone-replay, declared option by
// option. It keeps the command line library inside one source file.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "server/history/named_moment.hpp"

namespace CLI {
class App;
}

namespace runstone {

/// Options that every subcommand has.
struct CommonOptions {
  std::string world;      // place
  std::string json;       // file of the JSON report; empty: none
  bool progress = false;  // print progress on standard error even if it is no terminal
};

/// Every output parameter is set while the command line is parsed and must live until then. A name
/// without dashes declares a positional argument, which is required unless it may be missing. An
/// option given twice takes its last value.
class SubcommandOptions {
 public:
  enum class Presence { optional, required, may_be_missing };
  /// Stores the parsed text and returns "", or returns what is wrong with the text.
  using Parser = std::function<std::string(const std::string& text)>;

  explicit SubcommandOptions(CLI::App& app) : app_(app) {}

  /// Declares --world (required), --json and --progress. `world_help` describes the place.
  void common(CommonOptions& out, const std::string& world_help);
  void flag(const std::string& name, bool& out, const std::string& help);
  void text(const std::string& name, std::string& out, const std::string& help,
            Presence presence = Presence::optional);
  /// Declares the place of a world: a folder, or the address of a database.
  void place(const std::string& name, std::string& out, const std::string& help,
             Presence presence = Presence::optional);
  /// Declares a folder, which is no database.
  void folder(const std::string& name, std::string& out, const std::string& help);
  void existing_file(const std::string& name, std::string& out, const std::string& help);
  /// Declares a file to write. It may not be what output_refusal() refuses.
  void output_file(const std::string& name, std::string& out, const std::string& help,
                   Presence presence = Presence::optional);
  /// Declares one or more values behind one name.
  void texts(const std::string& name, std::vector<std::string>& out, const std::string& help);
  void number(const std::string& name, std::uint64_t& out, std::uint64_t min, std::uint64_t max,
              const std::string& help);
  void parsed(const std::string& name, Parser parser, const std::string& help,
              Presence presence = Presence::optional);
  void moment(const std::string& name, std::optional<NamedMoment>& out, const std::string& help,
              Presence presence = Presence::optional);

 private:
  CLI::App& app_;
};

}  // namespace runstone
