"""One model asked in random order, against a model loaded anew for each question."""

from __future__ import annotations

import json
import random
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from random_families.same_answers.answers import Kept, answer, loaded
from random_families.same_answers.files import mechanism
from random_families.same_answers.questions import question


def written_out(info, folder):
    for name, text in info["files"].items():
        path = Path(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def spoilt(number):
    """Leaves this number in memory that is free: what reads memory before it is written then shows it."""
    for size in range(1, 400):
        np.full(size, number)


def differences(seed, most=14, spoil=False):
    """Questions whose answer depends on what was asked before: (question, history, shared, fresh)."""
    rng = random.Random(seed)
    info = mechanism(seed, faults=0.05)
    found, asked = [], 0
    with tempfile.TemporaryDirectory() as folder:
        written_out(info, folder)
        try:
            shared = loaded(info, folder)
        except Exception:
            return found, asked, info
        pool = [question(rng, info) for _ in range(most)]
        steps = []
        while pool or rng.random() < 0.7:
            if pool:
                step = [pool.pop() for _ in range(min(len(pool), rng.choice([1, 1, 1, 3])))]
            else:
                step = [rng.choice(rng.choice(steps))]
            steps.append(step * 3 if len(step) == 1 and rng.random() < 0.15 else step)
        rng.shuffle(steps)
        questions = [q for step in steps for q in step]
        kept, history, answers = Kept(rng), [], []
        for step in steps:
            if spoil:
                spoilt(rng.choice([np.nan, np.inf, 1e300, -7.5]))
            if len(step) > 1:
                with ThreadPoolExecutor(len(step)) as pool:
                    answers += pool.map(lambda q: answer(shared, q, kept), step)
            else:
                answers.append(answer(shared, step[0], kept))
            history += [{**q, "together": len(step)} for q in step]
        fresh = {}
        for i, q in enumerate(questions):
            key = json.dumps({k: v for k, v in q.items() if k != "knobs"})
            if key not in fresh:
                if spoil:
                    spoilt(0.0)
                plainest = {} if "knobs" in q else None
                fresh[key] = answer(loaded(info, folder), q, knobs=plainest)
            asked += 1
            if answers[i] != fresh[key]:
                found.append((q, history[: i + 1], answers[i], fresh[key]))
    return found, asked, info


def shortest(one, other, width=600):
    for a, b in zip(one, other):
        if a != b:
            at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            at = max(0, at - 80)
            return f"{a[:60]}\n   ...{a[at : at + width]}\n   ...{b[at : at + width]}"
    return f"{len(one)} and {len(other)} lines"
