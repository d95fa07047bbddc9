// AddressForm: how much of a peer's address the log shows.
#pragma once

namespace runstone {

enum class AddressForm {
  full,    // with the port
  prefix,  // the /24 of an IPv4 address, the /48 of an IPv6 address
  none
};

}  // namespace runstone
