import os
import sys

sys.path.insert(0, os.path.join(os.environ["LEAPMAP_BUILD"], "python"))
