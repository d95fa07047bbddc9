/* zstd as the WebAssembly of @runstone/core has it: one unit, compiled for size. The package is
 * smaller by the parts that chunk bytes never use.
 *
 * The packer of chunks (protocol/chunks/packed_body.cpp) compresses with one level, in one call and
 * without a dictionary. zstd then searches for matches by `greedy`, `greedy_row` or `lazy`, as the
 * size of the chunk's body requires. The other searches are replaced by literals_only(). It finds no
 * match: what it compresses is larger, and any decoder reads it. */
#define DEBUGLEVEL 0
#define XXH_NAMESPACE ZSTD_
#define XXH_PRIVATE_API
#define XXH_INLINE_ALL
#define ZSTD_LEGACY_SUPPORT 0
#define ZSTD_TRACE 0
#define ZSTD_DISABLE_ASM 1
#define ZSTD_NO_INLINE 1
#define ZSTD_STRIP_ERROR_STRINGS 1
#define HUF_FORCE_DECOMPRESS_X1 1
#define ZSTD_FORCE_DECOMPRESS_SEQUENCES_SHORT 1

#include "common/debug.c"
#include "common/entropy_common.c"
#include "common/error_private.c"
#include "common/fse_decompress.c"
#include "common/zstd_common.c"

#include "decompress/huf_decompress.c"
#include "decompress/zstd_ddict.c"
#include "decompress/zstd_decompress.c"
#include "decompress/zstd_decompress_block.c"

#include "compress/fse_compress.c"
#include "compress/hist.c"
#include "compress/huf_compress.c"
#include "compress/zstd_compress_literals.c"
#include "compress/zstd_compress_sequences.c"
#include "compress/zstd_compress_superblock.c"
#include "compress/zstd_double_fast.c"
#include "compress/zstd_fast.c"
#include "compress/zstd_lazy.c"
#include "compress/zstd_ldm.c"
#include "compress/zstd_opt.c"

static size_t literals_only(ZSTD_matchState_t* matches, seqStore_t* sequences,
                            U32 repetitions[ZSTD_REP_NUM], void const* source, size_t bytes) {
  (void)matches, (void)sequences, (void)repetitions, (void)source;
  return bytes; /* the literals after the last match */
}
#define ZSTD_compressBlock_fast literals_only
#define ZSTD_compressBlock_fast_dictMatchState literals_only
#define ZSTD_compressBlock_fast_extDict literals_only
#define ZSTD_compressBlock_doubleFast literals_only
#define ZSTD_compressBlock_doubleFast_dictMatchState literals_only
#define ZSTD_compressBlock_doubleFast_extDict literals_only
#define ZSTD_compressBlock_btlazy2 literals_only
#define ZSTD_compressBlock_btlazy2_dictMatchState literals_only
#define ZSTD_compressBlock_btlazy2_extDict literals_only
#define ZSTD_compressBlock_btopt literals_only
#define ZSTD_compressBlock_btopt_dictMatchState literals_only
#define ZSTD_compressBlock_btopt_extDict literals_only
#define ZSTD_compressBlock_btultra literals_only
#define ZSTD_compressBlock_btultra_dictMatchState literals_only
#define ZSTD_compressBlock_btultra_extDict literals_only
#define ZSTD_compressBlock_btultra2 literals_only
#define ZSTD_compressBlock_greedy_dictMatchState literals_only
#define ZSTD_compressBlock_greedy_dictMatchState_row literals_only
#define ZSTD_compressBlock_greedy_dedicatedDictSearch literals_only
#define ZSTD_compressBlock_greedy_dedicatedDictSearch_row literals_only
#define ZSTD_compressBlock_greedy_extDict literals_only
#define ZSTD_compressBlock_greedy_extDict_row literals_only
#define ZSTD_compressBlock_lazy_dictMatchState literals_only
#define ZSTD_compressBlock_lazy_dictMatchState_row literals_only
#define ZSTD_compressBlock_lazy_dedicatedDictSearch literals_only
#define ZSTD_compressBlock_lazy_dedicatedDictSearch_row literals_only
#define ZSTD_compressBlock_lazy_extDict literals_only
#define ZSTD_compressBlock_lazy_extDict_row literals_only
#define ZSTD_compressBlock_lazy2_dictMatchState literals_only
#define ZSTD_compressBlock_lazy2_dictMatchState_row literals_only
#define ZSTD_compressBlock_lazy2_dedicatedDictSearch literals_only
#define ZSTD_compressBlock_lazy2_dedicatedDictSearch_row literals_only
#define ZSTD_compressBlock_lazy2_extDict literals_only
#define ZSTD_compressBlock_lazy2_extDict_row literals_only
#define ZSTD_compressBlock_lazy2 literals_only
#define ZSTD_compressBlock_lazy_row literals_only
#define ZSTD_compressBlock_lazy2_row literals_only
#include "compress/zstd_compress.c"
