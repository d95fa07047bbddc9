// Record memory: OpenSSL allocates a buffer of a record's size, about 17 KB, for each read, write
// and handshake, and frees it. Between the small objects of connections such buffers leave holes in
// the heap: 1,000 connections took 64 KB more each. So blocks of that size are kept and used again.
#pragma once

namespace runstone {

/// Makes OpenSSL use recycled blocks for buffers of a record's size, in the whole process. Has no
/// effect after OpenSSL has allocated anything. Thread: any.
void recycle_record_memory();

}  // namespace runstone
