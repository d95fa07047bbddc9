// openssl_error: the reason of the last failure of OpenSSL in this thread.
#pragma once
#include <string>

namespace runstone {

/// Takes the oldest error from OpenSSL's queue of this thread and empties the queue. Returns its
/// reason, such as "wrong version number", or `otherwise` if the queue is empty.
std::string take_openssl_error(const char* otherwise);

}  // namespace runstone
