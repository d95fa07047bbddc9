#include "common/os/low_priority.hpp"

#include <algorithm>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace runstone {

void lower_priority() {
#ifdef __linux__
  constexpr int kNice = 10;
  const auto self = static_cast<id_t>(::gettid());
  static_cast<void>(
      ::setpriority(PRIO_PROCESS, self, std::max(kNice, ::getpriority(PRIO_PROCESS, self))));
#endif
}

}  // namespace runstone
