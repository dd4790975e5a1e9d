"""Writes the files of the viewer as a C source, so that every page holds them whole.

    embed.py NAME=FILE[,FILE]... > ms_view_embedded.c

Of each the text, ms_view_NAME, that of several files one behind the other, and its SHA-256 in base64,
ms_view_NAME_hash, by which a page's content security policy allows it and nothing else.
"""
import base64
import hashlib
import sys


def main():
    print('#include "view/ms_view_embedded.h"')
    for argument in sys.argv[1:]:
        name, paths = argument.split("=", 1)
        data = b""
        for path in paths.split(","):
            with open(path, "rb") as stream:
                data += stream.read()
        digest = base64.b64encode(hashlib.sha256(data).digest()).decode()
        numbers = [str(byte) for byte in data + b"\0"]
        rows = [",".join(numbers[at:at + 24]) for at in range(0, len(numbers), 24)]
        print(f"\nconst char ms_view_{name}_hash[] = \"{digest}\";")
        print(f"const char ms_view_{name}[] = {{\n" + ",\n".join(rows) + "};")


main()
