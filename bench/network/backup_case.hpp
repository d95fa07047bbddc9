// Backup: builders edit in one place while the world, of which most lies elsewhere, is backed up
// again and again. Windows with and without backups take turns against one server, because a
// machine's noise changes within minutes. Measured are the latency of the builders' edits, the time
// of a backup and the size of the WAL that it holds back.
#pragma once
#include "bench/network/testbed.hpp"

namespace runstone::bench {

Done measure_backup(Testbed& testbed, NetFindings& findings);

}  // namespace runstone::bench
