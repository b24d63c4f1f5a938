"""Opens orchard's window on a display of its own, presses keys and the mouse as a user would, and looks at what it says.

window_test.py ORCHARD TREE.orchard MESH.obj FOLDER
"""
import ctypes
import ctypes.util
import os
import re
import subprocess
import sys
import threading
import time

PATIENCE = 60  # seconds, for anything; a loaded machine draws slowly


class XEvent(ctypes.Structure):
    """XKeyEvent and XButtonEvent are alike in all that is set here."""
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("root", ctypes.c_ulong),
                ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong), ("x", ctypes.c_int), ("y", ctypes.c_int),
                ("x_root", ctypes.c_int), ("y_root", ctypes.c_int), ("state", ctypes.c_uint), ("detail", ctypes.c_uint),
                ("same_screen", ctypes.c_int), ("room", ctypes.c_long * 24)]


KEY_PRESS, KEY_RELEASE, BUTTON_PRESS, BUTTON_RELEASE = 2, 3, 4, 5
MASKS = {KEY_PRESS: 1, KEY_RELEASE: 2, BUTTON_PRESS: 4, BUTTON_RELEASE: 8}


class Screen:
    def __init__(self, name):
        self.x = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self.x.XOpenDisplay.restype = ctypes.c_void_p
        self.x.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
        self.x.XStringToKeysym.restype = ctypes.c_ulong
        self.display = ctypes.c_void_p(self.x.XOpenDisplay(name.encode()))
        assert self.display, "no display"
        self.root = self.x.XDefaultRootWindow(self.display)

    def find(self, title):
        root, parent, children = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.POINTER(ctypes.c_ulong)()
        count = ctypes.c_uint()
        self.x.XQueryTree(self.display, ctypes.c_ulong(self.root), ctypes.byref(root), ctypes.byref(parent),
                          ctypes.byref(children), ctypes.byref(count))
        for i in range(count.value):
            name = ctypes.c_char_p()
            self.x.XFetchName(self.display, ctypes.c_ulong(children[i]), ctypes.byref(name))
            if name.value and title in name.value.decode():
                return children[i]
        return None

    def send(self, window, kind, detail, x=10, y=10):
        event = XEvent(type=kind, send_event=1, window=window, root=self.root, x=x, y=y, x_root=x, y_root=y,
                       detail=detail, same_screen=1)
        self.x.XSendEvent(self.display, ctypes.c_ulong(window), 1, ctypes.c_long(MASKS[kind]), ctypes.byref(event))
        self.x.XFlush(self.display)

    def press(self, window, key, release=True):
        code = self.x.XKeysymToKeycode(self.display, ctypes.c_ulong(self.x.XStringToKeysym(key.encode())))
        self.send(window, KEY_PRESS, code)
        if release:
            self.send(window, KEY_RELEASE, code)

    def click(self, window, x, y):
        self.send(window, BUTTON_PRESS, 1, x, y)
        self.send(window, BUTTON_RELEASE, 1, x, y)


class Program:
    def __init__(self, command, display):
        self.process = subprocess.Popen(command, env={**os.environ, "DISPLAY": display}, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True)
        self.lines = []
        threading.Thread(target=lambda: self.lines.extend(iter(self.process.stdout.readline, "")), daemon=True).start()

    def has_said(self, pattern, after=0):
        """The number of lines up to the first one that matches; 0 if there is none."""
        return next((i for i, line in enumerate(self.lines[after:], after + 1) if re.search(pattern, line)), 0)

    def says(self, pattern, after=0):
        """The same once there is one."""
        end = time.time() + PATIENCE
        while time.time() < end:
            if found := self.has_said(pattern, after):
                return found
            assert self.process.poll() is None or self.lines[after:], f"it ended: {self.lines}"
            time.sleep(0.05)
        raise AssertionError(f"it did not say {pattern!r} after line {after} of {self.lines}")


def main():
    orchard, tree, mesh, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    picture = os.path.join(folder, "window.png")
    if os.path.exists(picture):
        os.remove(picture)
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-noreset"],
                              pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    program = None
    try:
        os.close(writing)
        display = ":" + os.read(reading, 16).decode().strip()
        screen = Screen(display)
        program = Program([orchard, "view", tree, mesh, "--window", "--level", "1", "-o", picture, "--size", "400x300"],
                          display)
        at = program.says(r"level 1: .*spheres")
        end = time.time() + PATIENCE
        while not (window := screen.find("orchard")):
            assert time.time() < end, "there is no window"
            time.sleep(0.1)
        end = time.time() + PATIENCE
        while not program.has_said(r"level 0: .*1 sphere\b", at):  # a window is there before it listens
            assert time.time() < end, "it does not listen"
            screen.press(window, "0")
            time.sleep(1)
        screen.press(window, "Up")
        at = program.says(r"level 1: .*spheres", at)
        screen.press(window, "Up")
        at = program.says(r"level 2: .*spheres", at)
        screen.press(window, "0")
        at = program.says(r"level 0: .*1 sphere\b", at)
        screen.press(window, "o")
        at = program.says(r"opacity 0\.06", at)
        screen.click(window, 200, 140)
        at = program.says(r"node 0, level 0, parent -1, centre .*, radius ", at)
        screen.press(window, "s")
        at = program.says(r"saved .*window\.png", at)
        assert os.path.getsize(picture) > 1000, "the picture is empty"
        screen.press(window, "q", release=False)  # to a window that is gone there is nothing to send
        assert program.process.wait(PATIENCE) == 0, "it did not end well"
        print("the window did what it was told")
    finally:
        if program and program.process.poll() is None:
            program.process.kill()
        server.terminate()
        server.wait()


main()
