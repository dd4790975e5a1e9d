#include "base/ms_version.h"

const char *ms_version(void)
{
    return MS_VERSION;
}
