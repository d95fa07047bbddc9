#include "server/admin/copy_program.hpp"

#include <optional>
#include <ostream>

#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/store/copy_stored_world.hpp"
#include "server/store/store.hpp"

namespace runstone {

Result<void, std::string> copy_between(const CopyRequest& request, std::ostream& out) {
  std::optional<NewFolder> folder;
  if (!is_database(request.to)) {
    auto made = NewFolder::make(request.to, out);
    if (!made) return failure(made.error());
    folder.emplace(*std::move(made));
  }
  const auto copied = [&] {
    ProgressLine line("rows copied", request.progress);
    return copy_stored_world(request.from, folder ? folder->path() : request.to,
                             [&](std::uint64_t rows, std::uint64_t all) { line.show(rows, all); });
  }();
  if (!copied) return failure(copied.error().message());
  if (folder) {
    const auto finished = folder->finish("world.sqlite");
    if (!finished) return failure(finished.error());
  }
  out << "copied      " << copied->rows << " rows; the log ends at seq=" << copied->last << '\n'
      << "verified    every row of the copy but the tiles\n"
      << "It is the same world: start only one of the two from now on.\n";
  return {};
}

}  // namespace runstone
