# SPDX-License-Identifier: GPL-3.0-or-later
"""Firefox without a window, driven by the Marionette protocol that it speaks itself: Debian has no
geckodriver."""
import json
import socket
import subprocess
import time


class Firefox:
    """What tests use of selenium's drivers: get() and execute_script()."""

    def __init__(self, profile, port=2828):
        (profile / "user.js").write_text(f'user_pref("marionette.port", {port});\n')
        self.process = subprocess.Popen(
            ["firefox-esr", "--headless", "--no-remote", "--marionette", "--profile", profile],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(300):
            try:
                self.stream = socket.create_connection(("127.0.0.1", port), 60).makefile("rwb")
                break
            except OSError:
                time.sleep(0.2)
        else:
            raise TimeoutError("firefox-esr does not listen")
        self.number = 0
        self.message()  # who speaks
        self.command("WebDriver:NewSession", {})

    def message(self):
        length = b""
        while (byte := self.stream.read(1)) != b":":
            length += byte
        return json.loads(self.stream.read(int(length)))

    def command(self, name, parameters):
        self.number += 1
        text = json.dumps([0, self.number, name, parameters]).encode()
        self.stream.write(b"%d:%s" % (len(text), text))
        self.stream.flush()
        _, _, error, result = self.message()
        assert error is None, error
        return result

    def get(self, address):
        self.command("WebDriver:Navigate", {"url": address})

    def execute_script(self, script, *arguments):
        return self.command("WebDriver:ExecuteScript", {"script": script, "args": list(arguments)})["value"]

    def quit(self):
        self.process.terminate()
        self.process.wait(30)
