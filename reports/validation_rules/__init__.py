"""Our number and the verdict for each line of the validation report, a module for each paper of the thesis."""
