/** What a library is worth, for people and for machines. */
#ifndef MS_LIBRARY_REPORT_H
#define MS_LIBRARY_REPORT_H

#include <jansson.h>
#include <stdio.h>

#include "ms_library_write.h"

/** @param folder of the library */
void ms_library_report_print(FILE *stream, const ms_library *library, const ms_library_written *written,
                             const char *folder);

/** The same; the caller owns it; NULL without memory. */
json_t *ms_library_report_json(const ms_library *library, const ms_library_written *written);

#endif
