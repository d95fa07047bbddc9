// The memory that the processes of a machine or container may use together.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace runstone {

/// Returns the bytes of main memory, or the limit of the process's control group (Linux cgroup v2)
/// if that is less. Returns nullopt if the system does not say.
std::optional<std::uint64_t> usable_memory_bytes();

/// Returns the least limit in the text of files `memory.max` of control groups, or nullopt if none
/// of them is a number: "max" stands for no limit.
std::optional<std::uint64_t> memory_limit_of(const std::string& text);

}  // namespace runstone
