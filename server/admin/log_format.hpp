#pragma once

namespace runstone {

/// The form of the lines that are logged.
enum class LogFormat {
  text,  // for people
  json   // one object a line
};

}  // namespace runstone
