// read_log_backwards: the records of the log that match a filter, from its end to its beginning. It
// blocks on the disk.
#pragma once
#include <functional>

#include "server/rollback/selection.hpp"

namespace runstone {

/// Reads the log in windows from its end, each twice as wide as the one before, so that a filter that
/// matches many records reads few of them. Calls `wants_window` before each window, and ends if it
/// returns false. Calls `to_record` for each record that matches, ascending within a window.
StoreResult<void> read_log_backwards(LogReader& reader, const SelectionFilter& filter,
                                     const std::function<bool()>& wants_window,
                                     const std::function<void(const EditRecord&)>& to_record);

}  // namespace runstone
