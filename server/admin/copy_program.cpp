#include "server/admin/copy_program.hpp"

#include <ostream>

#include "common/os/progress_line.hpp"
#include "server/store/copy_stored_world.hpp"

namespace runstone {

Result<void, std::string> copy_between(const CopyRequest& request, std::ostream& out) {
  ProgressLine line("rows copied", request.progress);
  const auto copied =
      copy_stored_world(request.from, request.to,
                        [&](std::uint64_t rows, std::uint64_t all) { line.show(rows, all); });
  if (!copied) return failure(copied.error().message());
  out << "copied      " << copied->rows << " rows; the log ends at seq=" << copied->last << '\n'
      << "verified    every row of the copy but the tiles\n"
      << "It is the same world: start only one of the two from now on.\n";
  return {};
}

}  // namespace runstone
