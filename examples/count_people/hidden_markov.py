"""A hidden Markov model whose hidden state is the number of people."""
import numpy as np


def forward_filter(prior, transition, likelihood):
    """P(state at t | what was seen until t), a row a step. `likelihood` [t, state] need not be normalised."""
    out = np.empty_like(likelihood, dtype=float)
    belief = np.asarray(prior, dtype=float)
    for t, seen in enumerate(likelihood):
        belief = (belief if t == 0 else belief @ transition) * seen
        belief = belief / belief.sum()
        out[t] = belief
    return out


def count_transitions(people, keep, n_states):
    """How often one number of people followed another, where both readings are kept."""
    pairs = keep[1:] & keep[:-1]
    counts = np.zeros((n_states, n_states))
    np.add.at(counts, (people[:-1][pairs], people[1:][pairs]), 1.0)
    return counts
