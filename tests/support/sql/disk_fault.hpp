// DiskFault: an error of the system that SQLite meets (FaultVfs), the words that must name it, and
// runs that meet it.
#pragma once
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/sql/fault_vfs.hpp"

namespace runstone::test {

struct DiskFault {
  int system_error = 0;
  FaultVfs::Lasts lasts = FaultVfs::Lasts::once;
  std::string text() const {
    return std::strerror(system_error) +
           std::string(lasts == FaultVfs::Lasts::once ? ", once" : ", for ever");
  }
};

inline std::vector<DiskFault> all_disk_faults() {
  std::vector<DiskFault> all;
  for (const int system_error : {ENOSPC, EDQUOT, EFBIG, EROFS, EIO}) {
    for (const auto lasts : {FaultVfs::Lasts::once, FaultVfs::Lasts::for_ever})
      all.push_back({system_error, lasts});
  }
  return all;
}

/// Returns true if an error names the fault.
inline bool says_why(const std::string& what, const DiskFault& fault) {
  const auto has = [&](const char* part) { return what.find(part) != std::string::npos; };
  if (has(std::strerror(fault.system_error))) return true;
  // The words of SQLite for ENOSPC.
  if (fault.system_error == ENOSPC && has("database or disk is full")) return true;
  // SQLite loses the error of a file that it could not make, and this one has passed.
  return fault.lasts == FaultVfs::Lasts::once &&
         has("cannot be made, but another one can be made there now: try again");
}

/// Calls `run(vfs, fault)` with each fault at every `stride`-th call that can have its error
/// (FaultVfs::fail()), until a run ends before its fault. The numbers of the first calls are spread
/// evenly over the stride. So all faults together meet every number of a call if the stride is at most
/// the number of faults, and otherwise about every (stride / number of faults)-th one. `run` ends the
/// fault with FaultVfs::heal(). Returns the number of runs.
template <class Run>
std::uint64_t meet_disk_faults(std::uint64_t stride, const Run& run) {
  constexpr std::uint64_t kCallsMax = 20'000;
  FaultVfs vfs;
  const std::vector<DiskFault> faults = all_disk_faults();
  std::uint64_t runs = 0;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const DiskFault& fault = faults[i];
    std::uint64_t call = 1 + i * stride / faults.size();
    do {
      REQUIRE(call < kCallsMax);
      INFO("call " << call << ", " << fault.text());
      vfs.fail(call, fault.system_error, fault.lasts);
      run(vfs, fault);
      vfs.heal();
      call += stride;
      ++runs;
    } while (vfs.has_failed());
  }
  return runs;
}

}  // namespace runstone::test
