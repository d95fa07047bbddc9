// OpensslPtr: owns an object of OpenSSL.
#pragma once
#include <memory>

namespace runstone {

template <auto Free>
struct OpensslDeleter {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
template <class T, auto Free>
using OpensslPtr = std::unique_ptr<T, OpensslDeleter<Free>>;

}  // namespace runstone
