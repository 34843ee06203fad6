"""Classes of records are built on their first use, which may be in several threads at once."""

import subprocess
import sys

LINES = """
import threading
from voxsoft.shapes import Box, Shell, Sphere
from voxsoft.design import Design, families
text = families.family_text("cylinder")
import tomllib
starting, wrong = threading.Barrier(8), []
def work():
    starting.wait()
    try:
        Shell(of=Box(size=(1, 1, 1)) - Sphere(radius=0.1), thickness=0.1)
        Design.from_document(tomllib.loads(text))
    except BaseException as error:
        wrong.append(error)
threads = [threading.Thread(target=work) for _ in range(8)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(len(wrong), *wrong[:1])
"""


def test_the_first_uses_of_a_class_may_come_at_once():
    # A process of its own: in this one other tests have built the classes.
    run = subprocess.run([sys.executable, "-c", LINES], capture_output=True, text=True, check=True)
    assert run.stdout == "0\n"
