/** Bytes as text. */
#ifndef MS_VIEW_BASE64_H
#define MS_VIEW_BASE64_H

#include <stddef.h>
#include <stdio.h>

/** RFC 4648, section 4, without line ends. */
void ms_view_base64_put(FILE *stream, const void *data, size_t size);

#endif
