// The functions of Asio that are not templates, compiled once (ASIO_SEPARATE_COMPILATION).
#include <asio/impl/src.hpp>
