import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # tests/, for support
sys.path.insert(0, os.path.join(os.environ["LEAPMAP_BUILD"], "python"))
