// Testbed: the common means of all network experiments: links, programs, worlds, and a folder that
// is removed with the testbed.
#pragma once
#include <iosfwd>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/network/child.hpp"
#include "bench/network/figure.hpp"
#include "bench/network/net_options.hpp"
#include "bench/network/testbed_link.hpp"
#include "common/core/result.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::bench {

/// The results of experiments: tables in Markdown, figures, targets.
struct NetFindings {
  std::string tables;
  std::vector<Figure> figures;
  std::vector<Target> targets;
};
using Done = Result<void, std::string>;

/// A running server and its address for clients.
struct TestbedServer {
  std::unique_ptr<Child> program;
  std::string address;     // HOST:PORT for clients
  std::uint16_t port = 0;  // the port on which the server listens, without the link
  std::string world = {};  // its folder; empty for a gateway
};

class Testbed {
 public:
  Testbed(const NetOptions& options, LinkKind kind, std::ostream& progress)
      : options_(options), kind_(kind), progress_(progress) {}

  const NetOptions& options() const { return options_; }
  LinkKind kind() const { return kind_; }
  std::ostream& progress() { return progress_; }
  /// Returns the wanted link profiles.
  std::vector<test::LinkProfile> profiles() const;
  Result<std::unique_ptr<TestbedLink>, std::string> make_link(const test::LinkProfile& profile);

  /// Returns a new path in the testbed's folder.
  std::string fresh(const std::string& name);
  /// Starts runstone-server on the folder `world` and waits until it listens. The server makes the
  /// world with `flags` if it is missing.
  Result<TestbedServer, std::string> start_server(TestbedLink& link, const std::string& world,
                                                  const std::vector<std::string>& flags);
  /// Starts runstone-web in front of a server, whose setting gateway_socket is `socket`, and waits
  /// until it listens.
  Result<TestbedServer, std::string> start_gateway(TestbedLink& link, const std::string& socket,
                                                   const std::vector<std::string>& flags);
  /// Stops a server or a gateway. Fails if it does not end properly.
  Done stop_server(TestbedServer& server);
  /// Starts one of the product's programs on the client side of the link. `log` as in Child.
  Result<std::unique_ptr<Child>, std::string> start_client(TestbedLink& link,
                                                           const std::string& program,
                                                           std::vector<std::string> arguments);
  /// Waits for the end of a program. Fails unless its exit code is 0.
  Done finish(Child& child, double seconds);
  /// Returns the folder of options().luanti as a world of this product. It is imported once.
  Result<std::string, std::string> imported_world();

 private:
  const NetOptions& options_;
  const LinkKind kind_;
  std::ostream& progress_;
  test::TempFolder folder_;
  std::uint64_t names_ = 0;
  std::string imported_;
};

/// Returns `flags` and those that take all limits off what players may cost, for experiments with
/// many clients on one address that measure something else.
std::vector<std::string> without_player_limits(std::vector<std::string> flags);

/// Reads a report of one of the product's programs.
Result<nlohmann::json, std::string> read_report(const std::string& file);
/// Returns a number of a report: infinite for "inf" and "infinite", 0 for null or a missing value.
double number_in(const nlohmann::json& value);

/// Returns the number behind `name=` in the last line of counters of a server's log, or 0 if there
/// is none.
double counter_in(const std::string& log, std::string_view name);

/// Returns true if a line of a program's log contains `what`.
bool output_has(const std::string& log, std::string_view what);

void write_text(const std::string& file, const std::string& text);

}  // namespace runstone::bench
