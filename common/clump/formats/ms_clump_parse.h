/** The reader of clump files from memory, so that fuzzers need no files. Private. */
#ifndef MS_CLUMP_PARSE_H
#define MS_CLUMP_PARSE_H

#include "base/ms_file.h"
#include "clump/ms_clump.h"

/**
 * @param[out]    clump the caller frees it; empty on failure
 * @param[in,out] bytes of the file, with the 0 byte behind them; separators become blanks
 * @param         name  of the file, for messages
 * @return as ms_clump_read
 */
ms_status ms_clump_parse(ms_clump *clump, ms_bytes *bytes, const char *name, ms_error *err);

#endif
