"""Mitsuba 3 loads a scene of `cargo xtask bench load` and says how long that takes, as one line of JSON.

The clock starts when Mitsuba is there, and stops when the scene with its tree is.
usage: mitsuba_peer.py SCENE.xml THREADS
"""
import json
import resource
import sys
import time

import mitsuba as mi

mi.set_variant("scalar_rgb")
mi.Thread.thread().logger().set_log_level(mi.LogLevel.Error)


def clocks():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime, time.perf_counter()


threads = int(sys.argv[2])
if hasattr(mi, "set_thread_count"):
    mi.set_thread_count(threads)
else:
    import drjit

    drjit.set_thread_count(threads)
cpu, wall = clocks()
mi.load_file(sys.argv[1], parallel=threads > 1)
after_cpu, after_wall = clocks()
print(json.dumps({"version": mi.__version__, "cpu": after_cpu - cpu, "wall": after_wall - wall}))
