/** The files of the viewer, as embed.py makes them when the program is built. */
#ifndef MS_VIEW_EMBEDDED_H
#define MS_VIEW_EMBEDDED_H

extern const char ms_view_script[], ms_view_script_hash[]; /* viewer.js; SHA-256, base64 */
extern const char ms_view_style[], ms_view_style_hash[];   /* viewer.css */
extern const char ms_view_frame[], ms_view_frame_hash[];   /* viewer.html */

#endif
