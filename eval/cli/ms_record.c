#include "ms_record.h"

#include <omp.h>
#include <sys/resource.h>

#include "clump/formats/ms_json.h"
#include "ms_json_object.h"
#include "ms_report.h"

json_t *ms_record_settings_json(const ms_settings *settings)
{
    json_t *json = json_object(), *planes = json_array();
    for (size_t o = 0; settings->options[o].name; o++) {
        char text[64];
        if (settings->options[o].type != MS_OPTION_PLANE) {
            ms_option_settings_text(text, sizeof text, settings, o);
            ms_json_object_set(&json, settings->options[o].name, json_string(text));
            continue;
        }
        for (size_t p = 0; p < settings->n_planes; p++) {
            const double *q = settings->plane[p];
            ms_json_object_append(&planes, json_pack("[f,f,f,f]", q[0], q[1], q[2], q[3]));
        }
        ms_json_object_set(&json, settings->options[o].name, json_incref(planes));
    }
    json_decref(planes);
    return json;
}

static json_t *stop_json(const ms_stop *stop)
{
    json_t *json = json_object();
    if (stop->spheres) {
        ms_json_object_set(&json, "spheres", json_integer((json_int_t)stop->spheres));
    }
    for (const ms_measure *m = ms_measures; m->name; m++) {
        if (ms_stop_asked(stop, m) > 0) {
            ms_json_object_set(&json, m->name, json_real(ms_stop_asked(stop, m)));
        }
    }
    if (stop->radius > 0) {
        ms_json_object_set(&json, "radius", json_real(stop->radius));
    }
    return json;
}

json_t *ms_record_json(const ms_generator *generator, const ms_settings *settings, const ms_stop *stop, uint64_t seed,
                       const ms_input *input, const ms_result *r)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const double cpu = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                       1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    json_t *seconds = json_pack("{s:f,s:f,s:f,s:f,s:f,s:f}", "read", input->read_seconds, "voxelize",
                                input->voxelize_seconds, "distance", input->distance_seconds, "generate",
                                r->generate_seconds, "score", r->score_seconds, "cpu", cpu);
    json_t *json = json_pack("{s:s,s:o,s:I,s:o,s:s,s:o,s:o,s:o,s:i,s:I}", "generator", generator->name, "options",
                             ms_record_settings_json(settings), "seed", (json_int_t)seed, "until", stop_json(stop),
                             "stopped_by", ms_stop_name(r->reason), "input", ms_report_input_json(input), "scores",
                             ms_report_metrics_json(&r->metrics), "seconds", seconds, "threads", omp_get_max_threads(),
                             "peak_memory_kb", (json_int_t)usage.ru_maxrss);
    if (r->volume.scale > 0) {
        ms_json_object_set(&json, "equal_volume", ms_report_equal_volume_json(&r->volume));
    }
    if (r->mass.particle.mass > 0) {
        ms_json_object_set(&json, "particle", ms_json_from_particle(&r->mass.particle));
    }
    if (r->mass.corrected) {
        ms_json_object_set(&json, "masses", ms_mass_json(&r->mass));
    }
    return json;
}
