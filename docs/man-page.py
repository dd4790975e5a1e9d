#!/usr/bin/env python3
"""Writes the manual page of a command from the table of its flags, from which its --help is, too.

    man-page.py MSKIT COMMAND > mskit-COMMAND.1
"""
import json
import subprocess
import sys


def roff(text):
    """Text as data: no character of it is a command of troff."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").split("\n")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in lines)


def flag_entry(flag):
    name = roff(("-" + flag["letter"] + ", " if flag["letter"] else "") + "--" + flag["name"])
    argument = f" \\fI{roff(flag['argument'])}\\fR" if flag["argument"] else ""
    return f".TP\n\\fB{name}\\fR{argument}\n{roff(flag['help'])}\n"


def main():
    program, name = sys.argv[1:]
    command = json.loads(subprocess.run([program, "help", name, "--json"], check=True, stdout=subprocess.PIPE).stdout)
    print(f""".TH MSKIT\\-{name.upper()} 1 "" mskit "User commands"
.SH NAME
mskit\\-{name} \\- {roff(command['summary'])}
.SH SYNOPSIS
.B mskit {name}
{roff(command['usage'])}
.SH OPTIONS""")
    for flag in command["flags"] + [{"letter": "h", "name": "help", "argument": None, "help": "print this"}]:
        print(flag_entry(flag), end="")
    print(f""".SH EXAMPLE
.EX
{roff(command['example'])}
.EE
.SH SEE ALSO
.BR mskit (1)""")


main()
