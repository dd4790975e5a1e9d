/** What `mskit contact` found: as a table, as CSV and as JSON. */
#ifndef MS_CONTACT_REPORT_H
#define MS_CONTACT_REPORT_H

#include <jansson.h>
#include <stdio.h>

#include "contact/ms_contact.h"

void ms_contact_report_print(FILE *stream, const ms_contact *contact);

/** Factors that would undo it, row by row, with their price. @param single restitution of one contact */
void ms_contact_report_factors(FILE *stream, const ms_contact *contact, double single);
json_t *ms_contact_report_factors_json(const ms_contact *contact, double single);

/** A line for each thing touched and overlap; what is not known is empty. */
void ms_contact_report_csv(FILE *stream, const ms_contact *contact);

/** All of it, with the numbers of contacts and how often each occurs; the caller owns it. */
json_t *ms_contact_report_json(const ms_contact *contact);

#endif
