#include "client/net/link_target.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace runstone::test {
namespace {

using Targets = std::vector<LinkTarget>;

const Servers kList{{{"[::1]:5000", "https://a.example:8443/world/valley/"},
                     {"b.example:4747", "http://b.example"},
                     {"c.example:4747", ""},
                     {"d.example:4747", "https://d.example"}},
                    0};

}  // namespace

TEST_CASE("a link to servers goes to their addresses, besides that of the sender", "[client_net]") {
  CHECK(other_servers(seen_from(kList, "c.example:4747")) ==
        Targets{{{"::1", 5000}}, {{"b.example", 4747}}, {{"d.example", 4747}}});
  CHECK(other_servers({}).empty());
}

TEST_CASE("a link to gateways goes to those with pages that are encrypted like it",
          "[client_net]") {
  CHECK(other_gateways(kList, true) ==
        Targets{{{"a.example", 8443}, "/world/valley/play"}, {{"d.example", 443}, "/play"}});
  CHECK(other_gateways(kList, false) == Targets{{{"b.example", 80}, "/play"}});
}

}  // namespace runstone::test
