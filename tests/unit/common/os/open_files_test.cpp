#include "common/os/open_files.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <limits>

using namespace runstone;

namespace {

/// Restores the limits of this process at the end.
class KeptLimits {
 public:
  KeptLimits() { REQUIRE(::getrlimit(RLIMIT_NOFILE, &before_) == 0); }
  ~KeptLimits() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  KeptLimits(const KeptLimits&) = delete;
  KeptLimits& operator=(const KeptLimits&) = delete;

  std::size_t hard() const { return before_.rlim_max; }
  void set_soft(std::size_t files) const {
    const rlimit limit{files, before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_NOFILE, &limit) == 0);
  }
  static std::size_t soft() {
    rlimit limit{};
    REQUIRE(::getrlimit(RLIMIT_NOFILE, &limit) == 0);
    return limit.rlim_cur;
  }

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("the limit of open files rises to the need or to the hard limit", "[process]") {
  const KeptLimits limits;
  REQUIRE(limits.hard() >= 128);
  limits.set_soft(64);
  CHECK(allow_open_files(100) == 100);
  CHECK(KeptLimits::soft() == 100);
  CHECK(allow_open_files(std::numeric_limits<std::size_t>::max()) == limits.hard());
  CHECK(KeptLimits::soft() == limits.hard());
}

TEST_CASE("the limit of open files is never lowered", "[process]") {
  const KeptLimits limits;
  limits.set_soft(100);
  CHECK(allow_open_files(64) == 100);
  CHECK(KeptLimits::soft() == 100);
}
