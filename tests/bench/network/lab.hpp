// Lab: what every experiment of the network lab needs: links, programs, worlds, and a folder that is gone with it.
#pragma once
#include <iosfwd>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/network/child.hpp"
#include "tests/bench/network/figure.hpp"
#include "tests/bench/network/lab_link.hpp"
#include "tests/bench/network/net_options.hpp"
#include "tests/support/temp_folder.hpp"

namespace runstone::bench {

/// What experiments found: tables in Markdown, figures, bars.
struct LabFindings {
  std::string tables;
  std::vector<Figure> figures;
  std::vector<Target> targets;
};
using Done = Result<void, std::string>;

/// A server that listens, and where clients find it.
struct LabServer {
  std::unique_ptr<Child> program;
  std::string address;     // HOST:PORT for clients
  std::uint16_t port = 0;  // where it listens itself, without the link
};

class Lab {
 public:
  Lab(const NetOptions& options, LinkKind kind, std::ostream& progress)
      : options_(options), kind_(kind), progress_(progress) {}

  const NetOptions& options() const { return options_; }
  LinkKind kind() const { return kind_; }
  std::ostream& progress() { return progress_; }
  /// Those that were asked for.
  std::vector<test::LinkProfile> profiles() const;
  Result<std::unique_ptr<LabLink>, std::string> make_link(const test::LinkProfile& profile);

  /// A path in the lab's folder that nobody was given before.
  std::string fresh(const std::string& name);
  /// Starts runstone-server on the folder `world`, which is made with `flags` if it is missing, and waits until it
  /// listens.
  Result<LabServer, std::string> start_server(LabLink& link, const std::string& world,
                                              const std::vector<std::string>& flags);
  /// Ends it properly; the error says what was wrong.
  Done stop_server(LabServer& server);
  /// Starts a program of ours in the link's client side. `log` as of Child.
  Result<std::unique_ptr<Child>, std::string> start_client(LabLink& link,
                                                           const std::string& program,
                                                           std::vector<std::string> arguments);
  /// Waits for it and requires exit code 0.
  Done finish(Child& child, double seconds);
  /// The world of options().luanti as a world of ours, imported once: its folder.
  Result<std::string, std::string> imported_world();

 private:
  const NetOptions& options_;
  const LinkKind kind_;
  std::ostream& progress_;
  test::TempFolder folder_;
  std::uint64_t names_ = 0;
  std::string imported_;
};

/// A report that one of our programs wrote.
Result<nlohmann::json, std::string> read_report(const std::string& file);
/// A number in it, or infinite for "inf" and "infinite"; 0 where there is null or nothing.
double number_in(const nlohmann::json& value);

/// The number behind `name=` in the last line of counters of a server's log; 0 if there is none.
double counter_in(const std::string& log, std::string_view name);

/// Whether a line of a program's log holds `what`.
bool output_has(const std::string& log, std::string_view what);

void write_text(const std::string& file, const std::string& text);

}  // namespace runstone::bench
