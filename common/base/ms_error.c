#include "ms_error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *ms_status_text(ms_status status)
{
    switch (status) {
#define MS_STATUS_CASE(code, text) \
    case code:                     \
        return text;
        MS_STATUS_LIST(MS_STATUS_CASE)
#undef MS_STATUS_CASE
    }
    return "unknown status";
}

ms_status ms_fail(ms_error *err, ms_status status, const char *format, ...)
{
    if (err) {
        va_list args;
        va_start(args, format);
        vsnprintf(err->text, sizeof err->text, format, args);
        va_end(args);
    }
    return status;
}

void ms_error_add(ms_error *text, const char *sentence)
{
    const size_t length = strlen(text->text);
    snprintf(text->text + length, sizeof text->text - length, "%s%s", length > 0 ? "; " : "", sentence);
}
