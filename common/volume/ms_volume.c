#include "ms_volume.h"

#include "ms_scan.h"

static ms_status take_all(ms_volume *volume, ms_scan *scan, ms_status status, size_t max_voxels, ms_error *err)
{
    *volume = (ms_volume){0};
    if (status == MS_OK) {
        status = ms_scan_volume(volume, scan, max_voxels, err);
    }
    ms_scan_close(scan);
    return status;
}

ms_status ms_volume_parse(ms_volume *volume, const ms_bytes *bytes, const char *path, size_t max_voxels, ms_error *err)
{
    ms_scan scan;
    const ms_scan_options options = ms_scan_defaults();
    return take_all(volume, &scan, ms_scan_parse(&scan, bytes, path, &options, max_voxels, err), max_voxels, err);
}

ms_status ms_volume_read(ms_volume *volume, const char *path, size_t max_voxels, ms_error *err)
{
    ms_scan scan;
    const ms_scan_options options = ms_scan_defaults();
    return take_all(volume, &scan, ms_scan_open(&scan, path, &options, max_voxels, err), max_voxels, err);
}
