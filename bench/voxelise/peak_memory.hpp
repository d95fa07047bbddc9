// The peak memory of a part of a program (Linux).
#pragma once
#include <malloc.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace runstone::bench {

class PeakMemory {
 public:
  /// Gives free memory back to the system, and begins to measure.
  PeakMemory() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
    begin_ = status_kib("VmRSS:");
  }
  /// Returns the most memory that the process had in RAM since then, less what it had then; 0 if
  /// the system does not tell.
  std::uint64_t bytes() const {
    const std::uint64_t peak = status_kib("VmHWM:");
    return peak > begin_ ? (peak - begin_) * 1024 : 0;
  }

 private:
  static std::uint64_t status_kib(const std::string& field) {
    std::ifstream in("/proc/self/status");
    for (std::string word; in >> word;) {
      std::uint64_t value = 0;
      if (word == field && in >> value) return value;
    }
    return 0;
  }
  std::uint64_t begin_ = 0;
};

}  // namespace runstone::bench
